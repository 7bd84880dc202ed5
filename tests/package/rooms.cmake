# Proves that the folders ("rooms") of include, src, shaders and apps include each other in one direction only.
# Each line below names a room and the rooms that it may include; a room may only name rooms of lines above its own, so
# that the list cannot contain a cycle. A file belongs to the room with the longest matching path. Rooms marked with
# VULKAN may use Vulkan; the others may not, directly or through a room that they include.
cmake_minimum_required(VERSION 3.25)

set(room_names)
macro(room name)
  set(allowed_${name} ${ARGN})
  set(vulkan_${name} NO)
  if("VULKAN" IN_LIST allowed_${name})
    set(vulkan_${name} YES)
    list(REMOVE_ITEM allowed_${name} VULKAN)
  endif()
  foreach(below ${allowed_${name}})
    if(NOT below IN_LIST room_names)
      message(SEND_ERROR "rooms.cmake: ${name} names ${below}, which is not above it in the list")
    elseif(vulkan_${below} AND NOT vulkan_${name})
      message(SEND_ERROR "rooms.cmake: ${name} is to be free of Vulkan but may include ${below}")
    endif()
  endforeach()
  list(APPEND room_names ${name})
endmacro()

# The public interface: parameters and results, then the effect itself.
room(include/tyndall)
room(include/tyndall/memory.hpp VULKAN include/tyndall)
room(include/tyndall/effect.hpp VULKAN include/tyndall/memory.hpp include/tyndall)
room(include/tyndall/sky_probe.hpp VULKAN include/tyndall/effect.hpp include/tyndall)
room(include/tyndall/post.hpp VULKAN include/tyndall/effect.hpp include/tyndall)
room(include/tyndall/atmosphere.hpp VULKAN include/tyndall/effect.hpp include/tyndall)
room(include/tyndall/tyndall_memory.h VULKAN)
room(include/tyndall/tyndall.h VULKAN include/tyndall/tyndall_memory.h include/tyndall)

# Shaders, and the structures that they share with C++.
room(shaders/shared include/tyndall)
room(shaders/lib shaders/shared)
room(shaders/precompute shaders/lib shaders/shared include/tyndall)
room(shaders/frame shaders/lib shaders/shared include/tyndall)
room(shaders/sky_probe shaders/frame shaders/lib shaders/shared include/tyndall)
room(shaders/public shaders/frame shaders/lib shaders/shared include/tyndall)
room(shaders/epipolar shaders/frame shaders/lib shaders/shared)
room(shaders/probe shaders/frame shaders/lib shaders/shared include/tyndall)
room(shaders/published shaders/lib shaders/shared)
room(shaders/post shaders/lib shaders/shared)
room(shaders/scene shaders/lib include/tyndall)
room(shaders/viewer)

# Constants of mathematics, for all rooms.
room(src/math)

# The coefficients that follow from the parameters of the atmosphere, for the effect and for the path tracer.
room(src/air src/math include/tyndall)

# The effect.
room(src/gpu VULKAN include/tyndall/effect.hpp include/tyndall/memory.hpp include/tyndall)
room(src/effect VULKAN src/air src/math src/gpu shaders/shared include/tyndall/sky_probe.hpp include/tyndall/atmosphere.hpp include/tyndall/effect.hpp include/tyndall)
room(src/c VULKAN src/gpu include/tyndall/sky_probe.hpp include/tyndall/atmosphere.hpp include/tyndall/effect.hpp include/tyndall/tyndall_memory.h include/tyndall/tyndall.h include/tyndall)
room(src/post VULKAN src/gpu shaders/post shaders/lib shaders/shared include/tyndall/post.hpp include/tyndall)

# Files, images and what describes a scene.
room(src/files include/tyndall)
room(src/image src/files include/tyndall)
room(src/scene/description src/math src/files include/tyndall)
room(src/config src/scene/description src/files include/tyndall)

# Models of scattering, and the reference that they are compared with. The reference shares only src/air with the others.
room(src/rays)
room(src/reference src/air src/math src/rays include/tyndall)
room(src/validate src/math src/reference src/rays src/files include/tyndall)
room(src/tables VULKAN src/gpu src/files include/tyndall/effect.hpp include/tyndall)
room(src/models VULKAN src/air src/rays src/tables src/effect src/gpu shaders/lib shaders/shared include/tyndall/effect.hpp include/tyndall)

# The demo engine. It is a client of the effect's public interface.
room(src/scene/elevation src/scene/description shaders/scene src/files include/tyndall)
room(src/scene/view VULKAN src/math src/scene/description shaders/scene include/tyndall/effect.hpp include/tyndall)
room(src/scene/terrain VULKAN src/scene/elevation src/scene/view src/scene/description shaders/scene src/gpu include/tyndall/effect.hpp
  include/tyndall)
room(src/scene/mesh VULKAN src/math src/scene/terrain src/scene/view src/scene/description shaders/scene src/gpu src/files include/tyndall)
room(src/scene/sky VULKAN src/math src/scene/terrain src/scene/view src/scene/description src/models src/gpu include/tyndall/sky_probe.hpp
  include/tyndall/effect.hpp include/tyndall)
room(src/scene VULKAN src/math src/scene/sky src/scene/mesh src/scene/terrain src/scene/view src/scene/elevation src/scene/description
  src/tables src/post src/image src/gpu include/tyndall/effect.hpp include/tyndall)

# The programs.
room(apps/viewer/platform VULKAN src/gpu include/tyndall)
room(apps/viewer/scenes VULKAN apps/viewer/platform src/config src/scene src/scene/terrain src/scene/elevation src/scene/view
  src/scene/description src/tables src/image src/files src/gpu include/tyndall/effect.hpp include/tyndall)
room(apps/viewer/gui VULKAN apps/viewer/scenes apps/viewer/platform src/config src/scene src/scene/description src/files
  include/tyndall)
room(apps/viewer VULKAN apps/viewer/gui apps/viewer/scenes apps/viewer/platform src/config src/scene src/scene/view
  src/scene/description src/tables src/image src/files src/gpu include/tyndall)
room(apps/tyndall VULKAN src/math src/air apps/viewer src/validate src/reference src/rays src/models src/scene src/scene/sky src/scene/mesh src/scene/elevation
  src/scene/description src/config src/tables src/image src/files src/effect src/gpu include/tyndall/effect.hpp include/tyndall)

# room_of(PATH VAR): the room that a path relative to SOURCE belongs to.
function(room_of path out)
  set(folder ${path})
  while(folder)
    if(folder IN_LIST room_names)
      set(${out} ${folder} PARENT_SCOPE)
      return()
    endif()
    get_filename_component(folder ${folder} DIRECTORY)
  endwhile()
  message(SEND_ERROR "${path} belongs to no room of tests/package/rooms.cmake")
  set(${out} NOTFOUND PARENT_SCOPE)
endfunction()

set(count 0)
foreach(top include src shaders apps)
  file(GLOB_RECURSE paths RELATIVE ${SOURCE} ${SOURCE}/${top}/*.cpp ${SOURCE}/${top}/*.hpp ${SOURCE}/${top}/*.h ${SOURCE}/${top}/*.inl
       ${SOURCE}/${top}/*.def ${SOURCE}/${top}/*.glsl ${SOURCE}/${top}/*.comp ${SOURCE}/${top}/*.vert ${SOURCE}/${top}/*.frag)
  foreach(path ${paths})
    room_of(${path} room)
    get_filename_component(folder ${path} DIRECTORY)
    file(STRINGS ${SOURCE}/${path} lines REGEX "^[ \t]*#[ \t]*include[ \t]*[\"<]")
    foreach(line ${lines})
      if(line MATCHES "<(vulkan|volk)" AND NOT vulkan_${room})
        message(SEND_ERROR "${path}: ${line}: ${room} must not use Vulkan")
      endif()
      if(NOT line MATCHES "\"" OR line MATCHES "\"([a-z_]+_shaders|shader_sources)\\.hpp\"")
        continue()  # a system header, or one that the build generates from shaders
      endif()
      string(REGEX REPLACE "^[^\"]*\"([^\"]+)\".*" "\\1" included "${line}")
      set(target NOTFOUND)
      foreach(base ${folder} include src shaders apps)
        if(EXISTS ${SOURCE}/${base}/${included})
          set(target ${base}/${included})
          break()
        endif()
      endforeach()
      if(NOT target)
        message(SEND_ERROR "${path}: ${line}: there is no such file")
        continue()
      endif()
      math(EXPR count "${count} + 1")
      room_of(${target} target_room)
      if(NOT target_room STREQUAL room AND NOT target_room IN_LIST allowed_${room})
        message(SEND_ERROR "${path}: ${line}: ${room} must not include ${target_room}")
      endif()
    endforeach()
  endforeach()
endforeach()
if(count LESS 500)
  message(SEND_ERROR "only ${count} includes were found: the search is broken")
endif()
message(STATUS "${count} includes between ${SOURCE}'s rooms point downwards")
