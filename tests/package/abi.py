#!/usr/bin/env python3
"""Compares the binary interface of the C functions with the one on record, tests/package/tyndall.abi.

usage: abi.py [--renew] SOURCE_FOLDER WORK_FOLDER COMPILER

Compiles a C library with an empty function for each declaration of tyndall.h, so that its debug information is that of
the header and nothing else, and compares it with the record by abidiff; any difference is an error. exports.py checks
that the real library exports the same functions. --renew writes the record instead.
"""
import os
import re
import subprocess
import sys

ADVICE = """
The C interface has changed. These changes are compatible: a new function, a new value of an enumeration, and a new member
at the end of a structure that begins with struct_size. Any other change breaks programs. It needs a new minor version
before 1.0, and a new major version from then on (docs/c_interface.md). Renew the record with: make abi"""


# The types of Vulkan that tyndall.h uses, so that the record does not depend on the installed headers of Vulkan.
VULKAN = """#pragma once
typedef struct VkInstance_T* VkInstance;
typedef struct VkPhysicalDevice_T* VkPhysicalDevice;
typedef struct VkDevice_T* VkDevice;
typedef struct VkCommandBuffer_T* VkCommandBuffer;
typedef struct VkPipelineCache_T* VkPipelineCache;
typedef struct VkBuffer_T* VkBuffer;
typedef struct VkImage_T* VkImage;
typedef struct VkImageView_T* VkImageView;
typedef struct VkSampler_T* VkSampler;
typedef struct VkDeviceMemory_T* VkDeviceMemory;
typedef struct VkAllocationCallbacks VkAllocationCallbacks;
typedef struct VkExtent2D { uint32_t width, height; } VkExtent2D;
typedef struct VkExtent3D { uint32_t width, height, depth; } VkExtent3D;
typedef struct VkOffset2D { int32_t x, y; } VkOffset2D;
typedef uint32_t VkBool32;
typedef uint64_t VkDeviceSize;
typedef int32_t VkFormat;
typedef int32_t VkResult;
typedef uint32_t VkFlags;
typedef VkFlags VkMemoryPropertyFlags;
typedef struct VkMemoryRequirements { VkDeviceSize size, alignment; uint32_t memoryTypeBits; } VkMemoryRequirements;
typedef int32_t VkImageLayout;
typedef struct VkDescriptorImageInfo { VkSampler sampler; VkImageView imageView; VkImageLayout imageLayout; } VkDescriptorImageInfo;
typedef void (*PFN_vkVoidFunction)(void);
typedef PFN_vkVoidFunction (*PFN_vkGetInstanceProcAddr)(VkInstance, const char*);
"""


def empty_functions(header):
    """Definitions for all functions that the text of the header declares."""
    text = re.sub(r"//[^\n]*", "", header)
    declarations = re.findall(r"^TYNDALL_API ([^;]*)\b(tyndall_\w+)(\([^;]*\));", text, re.M)
    out = ["#include <tyndall/tyndall.h>"]
    for kind, name, arguments in declarations:
        body = "{}" if kind.strip() == "void" else "{ return 0; }"
        out.append(f"{kind}{name}{arguments} {body}")
    return "\n".join(out) + "\n", len(declarations)


def main():
    arguments = [argument for argument in sys.argv[1:] if argument != "--renew"]
    source, work, compiler = os.path.abspath(arguments[0]), os.path.abspath(arguments[1]), arguments[2]
    include = os.path.join(source, "include")
    record = os.path.join(source, "tests/package/tyndall.abi")
    os.makedirs(os.path.join(work, "vulkan"), exist_ok=True)
    with open(os.path.join(work, "vulkan/vulkan.h"), "w", encoding="utf-8") as file:
        file.write(VULKAN)
    with open(os.path.join(include, "tyndall/tyndall.h"), encoding="utf-8") as file:
        code, count = empty_functions(file.read())
    if count < 30:
        print(f"{include}/tyndall/tyndall.h: only {count} functions were found; the search is broken")
        return 1
    with open(os.path.join(work, "tyndall.c"), "w", encoding="utf-8") as file:
        file.write(code)
    library = "libtyndall.so"
    subprocess.run([compiler, "-std=c99", "-g", "-shared", "-fPIC", "-nostdlib", "-w", "-I", ".", "-I", include, "tyndall.c", "-o", library],
                   cwd=work, check=True)
    if "--renew" in sys.argv:
        subprocess.run(["abidw", "--no-show-locs", "--no-corpus-path", "--no-comp-dir-path", "--out-file", record, library],
                       cwd=work, check=True)
        return 0
    result = subprocess.run(["abidiff", "--harmless", record, library], cwd=work)
    # Bits of the status: 1 and 2 are errors, 4 is a change, 8 is a change that is certain to break programs.
    if result.returncode & 12:
        print(ADVICE)
    return 1 if result.returncode else 0


if __name__ == "__main__":
    sys.exit(main())
