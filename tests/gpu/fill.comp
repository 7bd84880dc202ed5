// Work for timers: every invocation adds up `steps` numbers. In: a number; out: one value per invocation.
#version 460

layout(local_size_x = 64) in;

layout(constant_id = 0) const int kOffset = 0;
layout(std430, binding = 0) readonly buffer seed_block { float seed; };
layout(std430, binding = 1) writeonly buffer value_block { float values[]; };
layout(push_constant) uniform push_block { uint steps; };

void main() {
  float sum = seed + float(kOffset);
  for (uint i = 0u; i < steps; ++i) sum += sin(sum + float(gl_GlobalInvocationID.x));
  if (gl_GlobalInvocationID.x < uint(values.length())) values[gl_GlobalInvocationID.x] = sum;
}
