// The GLSL view of the parameters (shaders/shared/params.glsl) has the layout of tyndall::Params.
#include <gtest/gtest.h>
#include <spirv_cross_c.h>

#include <cstring>
#include <map>
#include <string>
#include <vector>

#include "files/files.hpp"
#include "tyndall/params.hpp"

namespace tyndall {
namespace {

struct Member {
  std::size_t offset = 0;
  std::size_t size = 0;
  bool real = false;
};

class Reflection {
 public:
  explicit Reflection(const std::string& spirv) {
    std::vector<SpvId> words(spirv.size() / sizeof(SpvId));
    std::memcpy(words.data(), spirv.data(), words.size() * sizeof(SpvId));
    if (spvc_context_create(&context_) != SPVC_SUCCESS) return;
    spvc_parsed_ir ir = nullptr;
    if (spvc_context_parse_spirv(context_, words.data(), words.size(), &ir) != SPVC_SUCCESS) return;
    if (spvc_context_create_compiler(context_, SPVC_BACKEND_NONE, ir, SPVC_CAPTURE_MODE_TAKE_OWNERSHIP, &compiler_) !=
        SPVC_SUCCESS) {
      return;
    }
    spvc_resources resources = nullptr;
    const spvc_reflected_resource* buffers = nullptr;
    std::size_t count = 0;
    if (spvc_compiler_create_shader_resources(compiler_, &resources) != SPVC_SUCCESS) return;
    spvc_resources_get_resource_list_for_type(resources, SPVC_RESOURCE_TYPE_STORAGE_BUFFER, &buffers, &count);
    if (count == 1) walk(buffers[0].base_type_id, "", 0);
  }
  Reflection(const Reflection&) = delete;
  Reflection& operator=(const Reflection&) = delete;
  ~Reflection() { spvc_context_destroy(context_); }

  std::map<std::string, Member> members;  // by path: "params.planet.radius_m"

 private:
  void walk(spvc_type_id id, const std::string& prefix, std::size_t base) {
    const spvc_type type = spvc_compiler_get_type_handle(compiler_, id);
    for (unsigned i = 0; i < spvc_type_get_num_member_types(type); ++i) {
      unsigned offset = 0;
      std::size_t size = 0;
      spvc_compiler_type_struct_member_offset(compiler_, type, i, &offset);
      spvc_compiler_get_declared_struct_member_size(compiler_, type, i, &size);
      const spvc_type_id member = spvc_type_get_member_type(type, i);
      const spvc_type member_type = spvc_compiler_get_type_handle(compiler_, member);
      const std::string name = prefix + spvc_compiler_get_member_name(compiler_, spvc_type_get_base_type_id(type), i);
      if (spvc_type_get_basetype(member_type) == SPVC_BASETYPE_STRUCT) {
        walk(spvc_type_get_base_type_id(member_type), name + ".", base + offset);
      } else {
        members[name] = {base + offset, size, spvc_type_get_basetype(member_type) == SPVC_BASETYPE_FP32};
      }
    }
  }

  spvc_context context_ = nullptr;
  spvc_compiler compiler_ = nullptr;
};

std::size_t size_of(ParamType type) {
  return type == ParamType::vec3 ? sizeof(Vec3) : type == ParamType::uvec4 ? sizeof(UVec4) : sizeof(float);
}

TEST(ConfigLayout, GlslAgreesWithCpp) {
  const Result<std::string> spirv = files::read_file(TYNDALL_LAYOUT_SPV, 1U << 24U);
  ASSERT_TRUE(spirv.ok()) << spirv.error().message;
  const Reflection reflection(spirv.value());
  ASSERT_EQ(reflection.members.size(), param_table().size());
  std::size_t total = 0;
  for (const ParamInfo& info : param_table()) {
    const std::string path = "params." + std::string(info.group) + "." + std::string(info.name);
    ASSERT_TRUE(reflection.members.contains(path)) << path;
    const Member& member = reflection.members.at(path);
    EXPECT_EQ(member.offset, info.offset) << path;
    EXPECT_EQ(member.size, size_of(info.type)) << path;
    EXPECT_EQ(member.real, info.type == ParamType::float32 || info.type == ParamType::vec3) << path;
    total += member.size;
  }
  EXPECT_EQ(total, sizeof(Params));  // no padding anywhere
}

}  // namespace
}  // namespace tyndall
