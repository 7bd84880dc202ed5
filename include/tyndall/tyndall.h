// The C interface: the whole library for C and for languages that call C functions. It is plain C99.
// Names follow those of C++: TyndallX is tyndall::X, TyndallX_y is X::y, and tyndall_effect_f is Effect::f. effect.hpp
// documents conventions, units, image layouts, synchronisation and ownership; this file states what differs in C.
//
// Status: functions return TyndallStatus_success or what went wrong. tyndall_last_error() then returns a line of text.
// A call that returns an error has changed nothing and has written nothing to its results. No C++ exception leaves a
// function.
// Versions: set `struct_size` of a structure that has it to its sizeof before each call, or call its function
// tyndall_..._defaults(). New members are only added at the end of such structures, so that a program still works with
// a later library. Structures without struct_size, functions and values of enumerations never change. Memory: strings
// and arrays that a function returns are constants of the library, unless it states how long they are valid. Results
// are written to memory of the caller. Threads: use each TyndallEffect and TyndallParams from one thread at a time.
// Different ones are independent.
#ifndef TYNDALL_TYNDALL_H
#define TYNDALL_TYNDALL_H

#include <stddef.h>
#include <stdint.h>
#include <vulkan/vulkan.h>

#include "tyndall/export.h"
#include "tyndall/tyndall_memory.h"
#include "tyndall/version.h"

#ifdef __cplusplus
extern "C" {
#endif

// The last value of each enumeration gives it 32 bits. It is never used.

typedef enum TyndallStatus {
  TyndallStatus_success = 0,
  TyndallStatus_invalid_argument = 1,    // an argument is outside its documented range
  TyndallStatus_unsupported_device = 2,  // the device lacks something that tyndall_requirements() lists
  TyndallStatus_out_of_memory = 3,       // host or device memory is exhausted
  TyndallStatus_device_lost = 4,         // the device is lost; destroy everything and start again
  TyndallStatus_vulkan = 5,              // any other VkResult; see tyndall_last_vk_result()
  TyndallStatus_io = 6,                  // a file could not be read or written
  TyndallStatus_max = 0x7FFFFFFF
} TyndallStatus;

typedef enum TyndallSeverity {
  TyndallSeverity_info = 0,
  TyndallSeverity_warning = 1,
  TyndallSeverity_max = 0x7FFFFFFF
} TyndallSeverity;

typedef enum TyndallOutputFormat {
  TyndallOutputFormat_rgba16f = 0,
  TyndallOutputFormat_rgba32f = 1,
  TyndallOutputFormat_max = 0x7FFFFFFF
} TyndallOutputFormat;

typedef enum TyndallParamType {
  TyndallParamType_float32 = 0,
  TyndallParamType_uint32 = 1,
  TyndallParamType_flag = 2,
  TyndallParamType_enumeration = 3,
  TyndallParamType_vec3 = 4,
  TyndallParamType_uvec4 = 5,
  TyndallParamType_string = 6,  // this and dvec3: only scenes of the demo engine have such parameters
  TyndallParamType_dvec3 = 7,
  TyndallParamType_max = 0x7FFFFFFF
} TyndallParamType;

// The parts of a frame; see tyndall_effect_record_part().
typedef enum TyndallFramePart {
  TyndallFramePart_whole = 0,
  TyndallFramePart_first = 1,
  TyndallFramePart_second = 2,
  TyndallFramePart_drop = 3,  // instead of second: ends the frame without drawing it
  TyndallFramePart_max = 0x7FFFFFFF
} TyndallFramePart;

// The work that a change of a parameter requires; see tyndall_params_affected().
typedef enum TyndallAffects {
  TyndallAffects_Frame = 0,
  TyndallAffects_Pipeline = 1,
  TyndallAffects_Resources = 2,
  TyndallAffects_Tables = 3,
  TyndallAffects_Everything = 4,
  TyndallAffects_max = 0x7FFFFFFF
} TyndallAffects;

#define TYNDALL_MAX_CASCADES 8U
#define TYNDALL_MAX_VIEWS 8U
#define TYNDALL_ATMOSPHERE_CONSTANTS_SIZE 512U

// Returns the version of the library that the program runs with, made with TYNDALL_MAKE_VERSION().
TYNDALL_API uint32_t tyndall_version(void);
// Returns the text of the last error in this thread: one line, "" if there was none. It is valid until the next error
// in this thread.
TYNDALL_API const char* tyndall_last_error(void);
// Returns the VkResult behind that error; 0 when there is none.
TYNDALL_API int32_t tyndall_last_vk_result(void);
// Returns the name of a status, such as "out_of_memory", or "unknown".
TYNDALL_API const char* tyndall_status_name(TyndallStatus status);

// The requirements for a device.
typedef struct TyndallRequirements {
  uint32_t struct_size;
  uint32_t api_version;
  uint32_t device_extension_count;
  const char* const* device_extensions;
} TyndallRequirements;
TYNDALL_API TyndallStatus tyndall_requirements(TyndallRequirements* requirements);

// All parameters of the effect, by the names of tyndall_param_info(), such as "atmosphere.mie_g". The values are always
// valid: a function that would set another one returns an error.
typedef struct TyndallParams TyndallParams;

// The description of one parameter.
typedef struct TyndallParamInfo {
  uint32_t struct_size;
  TyndallParamType type;
  uint32_t value_count;  // numbers that the parameter consists of: 1, 3 or 4
  TyndallAffects affects;
  const char* name;
  const char* choices;  // of an enumeration: the names of its values, separated by '|'; otherwise ""
  const char* unit;     // of numbers; "1" has no dimension
  const char* doc;
  double min;  // of each number
  double max;
} TyndallParamInfo;
// Returns the number of parameters. Later versions may add parameters anywhere in the list.
TYNDALL_API uint32_t tyndall_param_count(void);
TYNDALL_API TyndallStatus tyndall_param_info(uint32_t index, TyndallParamInfo* info);

// Creates parameters with their defaults. tyndall_params_destroy() accepts null.
TYNDALL_API TyndallStatus tyndall_params_create(TyndallParams** params);
TYNDALL_API void tyndall_params_destroy(TyndallParams* params);
TYNDALL_API TyndallStatus tyndall_params_copy(const TyndallParams* from, TyndallParams* to);
// Sets a number or a flag (0 or 1).
TYNDALL_API TyndallStatus tyndall_params_set_number(TyndallParams* params, const char* name, double value);
// Sets all numbers of a parameter; `count` must be its value_count. planet.ground_albedo and
// atmosphere.single_scattering_albedo also accept one number, which holds for the three channels; it can be read as one
// number while the three are equal.
TYNDALL_API TyndallStatus tyndall_params_set_numbers(TyndallParams* params, const char* name, const double* values,
                                                     uint32_t count);
// Sets an enumeration by the name of the value.
TYNDALL_API TyndallStatus tyndall_params_set_choice(TyndallParams* params, const char* name, const char* choice);
// Return the value of a parameter. The text of a choice is a constant of the library; do not free it.
TYNDALL_API TyndallStatus tyndall_params_get_number(const TyndallParams* params, const char* name, double* value);
TYNDALL_API TyndallStatus tyndall_params_get_numbers(const TyndallParams* params, const char* name, double* values,
                                                     uint32_t count);
TYNDALL_API TyndallStatus tyndall_params_get_choice(const TyndallParams* params, const char* name, const char** choice);
// Sets the phase function of atmosphere.mie_phase = table: values[i * wavelength_count + k] at angles_deg[i], from 0
// (straight ahead) to 180, and wavelengths_nm[k]. The arrays are copied. The conditions are those of
// PhaseTable::create() in phase_table.hpp. Call it before tyndall_params_set_choice(), which refuses "table" without a
// table.
TYNDALL_API TyndallStatus tyndall_params_set_phase_table(TyndallParams* params, const double* angles_deg,
                                                         uint32_t angle_count, const double* wavelengths_nm,
                                                         uint32_t wavelength_count, const double* values);
// Returns what the change from `before` to `after` requires: a mask of bits 1 << TyndallAffects.
TYNDALL_API TyndallStatus tyndall_params_affected(const TyndallParams* before, const TyndallParams* after,
                                                  uint32_t* mask);
// Returns the colour of the sun above the atmosphere, per irradiance of TyndallFrameInputs, in red, green and blue:
// white with scattering.color = rgb. For callers that draw the sun's disc, with the parameters of
// tyndall_effect_get_table_params().
TYNDALL_API TyndallStatus tyndall_params_sun_color(const TyndallParams* params, float color[3]);

// The Vulkan device, borrowed for the effect's whole life.
typedef struct TyndallDeviceInfo {
  uint32_t struct_size;
  uint32_t reserved;  // 0
  VkInstance instance;
  VkPhysicalDevice physical_device;
  VkDevice device;
  PFN_vkGetInstanceProcAddr get_instance_proc_addr;
  const VkAllocationCallbacks* allocator;
  VkPipelineCache pipeline_cache;
  // Receives remarks on suspicious inputs. The text is valid during the call.
  void (*message)(void* user, TyndallSeverity severity, const char* text);
  void* message_user;
  // For shader development: returns SPIR-V to use in place of the built-in shader of that name and sets `words` to its
  // length, or returns null. The format of the output is changed to that of the effect.
  const uint32_t* (*replace_shader)(void* user, const char* name, size_t* words);
  void* replace_shader_user;
  // The allocator for all images and buffers, as MemoryCallbacks of C++: both functions or neither.
  VkResult (*allocate_memory)(void* user, const TyndallMemoryRequest* request, TyndallMemoryBlock* block);
  void (*free_memory)(void* user, const TyndallMemoryBlock* block, VkDeviceSize bytes);
  void* memory_user;
} TyndallDeviceInfo;

typedef struct TyndallEffect TyndallEffect;

typedef struct TyndallEffectDesc {
  uint32_t struct_size;
  VkExtent2D max_extent;
  uint32_t frames_in_flight;
  uint32_t views;
  TyndallOutputFormat output_format;
  float sky_depth;
  VkFormat depth_format;
  VkBool32 shadow_depth_reversed;
  uint32_t max_cascades;
  uint32_t max_shadow_resolution;
  VkBool32 shadow_colors;
  VkBool32 timings;
  VkBool32 counters;
  uint32_t pipeline_threads;
  VkBool32 check_inputs;
  VkBool32 table_pipelines_later;
  VkBool32 clouds;
  const TyndallEffect* tables_of;
} TyndallEffectDesc;

typedef struct TyndallTexture {
  VkImageView view;
  VkImageLayout layout;
  VkOffset2D offset;
} TyndallTexture;

typedef struct TyndallCascade {
  float shadow_from_world[16];  // column-major, as all matrices
  float near_m;
  float far_m;
} TyndallCascade;

typedef struct TyndallCamera {
  float world_from_view[16];
  float clip_from_view[16];
} TyndallCamera;

typedef struct TyndallSun {
  float direction_to_sun[3];
  float irradiance[3];
  float angular_radius_rad;  // for tyndall_sun_irradiance() of shaders; frames do not depend on it
} TyndallSun;

typedef struct TyndallClouds {
  TyndallTexture map;
  float map_from_world[16];
} TyndallClouds;

typedef struct TyndallFrameInputs {
  uint32_t struct_size;
  VkExtent2D extent;
  VkBool32 shadow_color_depths;
  TyndallTexture color;
  TyndallTexture depth;
  TyndallTexture shadow_maps;
  TyndallTexture shadow_colors;
  TyndallTexture output;
  const TyndallCascade* cascades;
  uint32_t cascade_count;
  uint32_t shadow_resolution;
  uint32_t first_marched_cascade;
  uint32_t view;
  uint64_t frame_index;
  TyndallCamera camera;
  TyndallSun sun;
  float lowest_ground_m;
  TyndallClouds clouds;
} TyndallFrameInputs;

// The inputs of the uniform block of tyndall/atmosphere.glsl; see atmosphere.hpp.
typedef struct TyndallAtmosphereInputs {
  uint32_t struct_size;
  TyndallSun sun;
  double origin_from_centre_m[3];
  float clouds_from_position[16];
} TyndallAtmosphereInputs;

// Fill a structure with the defaults of C++ and set its struct_size. Call them with sizeof(structure).
TYNDALL_API TyndallStatus tyndall_device_info_defaults(TyndallDeviceInfo* info, size_t struct_size);
TYNDALL_API TyndallStatus tyndall_effect_desc_defaults(TyndallEffectDesc* desc, size_t struct_size);
TYNDALL_API TyndallStatus tyndall_frame_inputs_defaults(TyndallFrameInputs* inputs, size_t struct_size);
TYNDALL_API TyndallStatus tyndall_atmosphere_inputs_defaults(TyndallAtmosphereInputs* inputs, size_t struct_size);

typedef struct TyndallProgress {
  uint32_t done;
  uint32_t total;  // complete if both are equal
} TyndallProgress;

typedef struct TyndallMemoryUsage {
  uint32_t struct_size, reserved;
  VkDeviceSize persistent;
  VkDeviceSize transient;
  VkDeviceSize host;
} TyndallMemoryUsage;

typedef struct TyndallResourceMemory {
  const char* name;
  VkDeviceSize bytes;
} TyndallResourceMemory;

typedef struct TyndallPassTiming {
  const char* name;
  double gpu_ms;
} TyndallPassTiming;

typedef struct TyndallCounters {
  uint32_t struct_size, reserved;
  uint64_t samples_marched, march_steps;
  uint64_t tree_nodes_visited;
  uint64_t shadow_map_fetches;
  uint64_t pixels_corrected;
} TyndallCounters;

typedef struct TyndallLightTables {
  uint32_t struct_size, reserved;
  VkImageView sun_transmittance;
  VkImageView sky_irradiance;
} TyndallLightTables;

typedef struct TyndallTable {
  VkImage image;
  VkImageView view;
  VkExtent3D extent;
} TyndallTable;

typedef struct TyndallScatteringTables {
  uint32_t struct_size, reserved;
  TyndallTable single_rayleigh, single_mie, high_orders;
} TyndallScatteringTables;

// Returns the memory that an effect would use. Null `params` means the defaults, here and in tyndall_effect_create().
TYNDALL_API TyndallStatus tyndall_query_memory(const TyndallDeviceInfo* info, const TyndallEffectDesc* desc,
                                               const TyndallParams* params, TyndallMemoryUsage* memory);

// Writes the contents of the uniform block of tyndall/atmosphere.glsl. `size` must be
// TYNDALL_ATMOSPHERE_CONSTANTS_SIZE. Null `params` means the defaults.
TYNDALL_API TyndallStatus tyndall_atmosphere_constants(const TyndallParams* params,
                                                       const TyndallAtmosphereInputs* inputs, void* constants,
                                                       size_t size);

// Copies `info`, `desc` and `params`. tyndall_effect_destroy() accepts null.
TYNDALL_API TyndallStatus tyndall_effect_create(const TyndallDeviceInfo* info, const TyndallEffectDesc* desc,
                                                const TyndallParams* params, TyndallEffect** effect);
TYNDALL_API void tyndall_effect_destroy(TyndallEffect* effect);

// Takes over parameters and, unless `desc` is null, the settings that it may change.
TYNDALL_API TyndallStatus tyndall_effect_set_params(TyndallEffect* effect, const TyndallParams* params,
                                                    const TyndallEffectDesc* desc);
TYNDALL_API TyndallStatus tyndall_effect_get_params(const TyndallEffect* effect, TyndallParams* params);
// Returns the parameters of the tables in use, as table_params() of C++. Pass them to tyndall_params_sun_color() and
// tyndall_atmosphere_constants().
TYNDALL_API TyndallStatus tyndall_effect_get_table_params(const TyndallEffect* effect, TyndallParams* params);
// Returns how the next picture represents light, as picture_color() of C++: the constant text "rgb" or "spectral".
TYNDALL_API TyndallStatus tyndall_effect_picture_color(const TyndallEffect* effect, const char** choice);
TYNDALL_API TyndallStatus tyndall_effect_get_desc(const TyndallEffect* effect, TyndallEffectDesc* desc);
TYNDALL_API TyndallStatus tyndall_effect_set_shadow_colors(TyndallEffect* effect, VkBool32 shadow_colors);
TYNDALL_API TyndallStatus tyndall_effect_set_limits(TyndallEffect* effect, VkExtent2D max_extent, uint32_t max_cascades,
                                                    uint32_t max_shadow_resolution);

// A budget of UINT32_MAX does everything at once. `progress` may be null where a budget is given.
TYNDALL_API TyndallStatus tyndall_effect_prepare_pipelines(TyndallEffect* effect, uint32_t budget,
                                                           TyndallProgress* progress);
TYNDALL_API TyndallStatus tyndall_effect_precompute_progress(const TyndallEffect* effect, TyndallProgress* progress);
TYNDALL_API TyndallStatus tyndall_effect_record_precompute(TyndallEffect* effect, VkCommandBuffer cmd, uint32_t budget,
                                                           TyndallProgress* progress);

// Returns the key of the tables. `size` is the size of `key` [bytes] before the call, and the size of the key with its
// final 0 after it. The key is written if it fits; otherwise, and with null `key`, nothing is written.
TYNDALL_API TyndallStatus tyndall_effect_table_key(const TyndallEffect* effect, size_t* size, char* key);
TYNDALL_API TyndallStatus tyndall_effect_table_bytes(const TyndallEffect* effect, VkDeviceSize* bytes);
TYNDALL_API TyndallStatus tyndall_effect_record_save_tables(TyndallEffect* effect, VkCommandBuffer cmd, VkBuffer buffer,
                                                            VkDeviceSize offset);
TYNDALL_API TyndallStatus tyndall_effect_record_load_tables(TyndallEffect* effect, VkCommandBuffer cmd, VkBuffer buffer,
                                                            VkDeviceSize offset);

// Records the effect.
TYNDALL_API TyndallStatus tyndall_effect_record(TyndallEffect* effect, VkCommandBuffer cmd,
                                                const TyndallFrameInputs* inputs);
// Records a part of the effect; `whole` is tyndall_effect_record().
TYNDALL_API TyndallStatus tyndall_effect_record_part(TyndallEffect* effect, VkCommandBuffer cmd,
                                                     const TyndallFrameInputs* inputs, TyndallFramePart part);

TYNDALL_API TyndallStatus tyndall_effect_light_tables(const TyndallEffect* effect, TyndallLightTables* tables);
TYNDALL_API TyndallStatus tyndall_effect_scattering_tables(const TyndallEffect* effect,
                                                           TyndallScatteringTables* tables);
TYNDALL_API TyndallStatus tyndall_effect_memory(const TyndallEffect* effect, TyndallMemoryUsage* memory);
TYNDALL_API TyndallStatus tyndall_effect_counters(const TyndallEffect* effect, uint64_t frame_index, uint32_t view,
                                                  TyndallCounters* counters);
// Return arrays. `count` is the number of elements that the array has room for before the call, and the number that
// there are after it. As many as fit are written; with a null array, only the number is returned. Names are constants
// of the library.
TYNDALL_API TyndallStatus tyndall_effect_resources(TyndallEffect* effect, uint32_t* count,
                                                   TyndallResourceMemory* resources);
TYNDALL_API TyndallStatus tyndall_effect_atmosphere_images(const TyndallEffect* effect, uint32_t view, uint32_t* count,
                                                           VkDescriptorImageInfo* images);
TYNDALL_API TyndallStatus tyndall_effect_timings(TyndallEffect* effect, uint64_t frame_index, uint32_t view,
                                                 uint32_t* count, TyndallPassTiming* timings);
TYNDALL_API TyndallStatus tyndall_effect_precompute_timings(TyndallEffect* effect, uint32_t* count,
                                                            TyndallPassTiming* timings);

// A sky probe; tyndall/sky_probe.hpp documents it. Destroy it before its effect. tyndall_sky_probe_destroy() accepts
// null.
typedef struct TyndallSkyProbe TyndallSkyProbe;

typedef struct TyndallSkyProbeInputs {
  uint32_t struct_size;
  float altitude_m;
  float up[3];
  TyndallSun sun;
} TyndallSkyProbeInputs;
TYNDALL_API TyndallStatus tyndall_sky_probe_inputs_defaults(TyndallSkyProbeInputs* inputs, size_t struct_size);

typedef struct TyndallSkyCoefficients {
  uint32_t struct_size, reserved;
  VkBuffer buffer;
  VkDeviceSize offset;
  VkDeviceSize size;
} TyndallSkyCoefficients;

typedef struct TyndallSkyProbeDesc {
  uint32_t struct_size, frames_in_flight, cube_size;
} TyndallSkyProbeDesc;
TYNDALL_API TyndallStatus tyndall_sky_probe_desc_defaults(TyndallSkyProbeDesc* desc, size_t struct_size);

typedef struct TyndallSkyCube {
  uint32_t struct_size, size, levels, reserved;
  VkImage image;
  VkImageView view;
  VkSampler sampler;
} TyndallSkyCube;

// The functions that end in _with take all settings; the others make a probe without a cube map.
TYNDALL_API TyndallStatus tyndall_sky_probe_query_memory_with(const TyndallDeviceInfo* info,
                                                              const TyndallSkyProbeDesc* desc,
                                                              TyndallMemoryUsage* memory);
TYNDALL_API TyndallStatus tyndall_sky_probe_create_with(TyndallEffect* effect, const TyndallSkyProbeDesc* desc,
                                                        TyndallSkyProbe** probe);
TYNDALL_API TyndallStatus tyndall_sky_probe_query_memory(const TyndallDeviceInfo* info, uint32_t frames_in_flight,
                                                         TyndallMemoryUsage* memory);
TYNDALL_API TyndallStatus tyndall_sky_probe_create(TyndallEffect* effect, uint32_t frames_in_flight,
                                                   TyndallSkyProbe** probe);
TYNDALL_API void tyndall_sky_probe_destroy(TyndallSkyProbe* probe);
TYNDALL_API TyndallStatus tyndall_sky_probe_record(TyndallSkyProbe* probe, VkCommandBuffer cmd,
                                                   const TyndallSkyProbeInputs* inputs, uint32_t budget,
                                                   TyndallProgress* progress);
TYNDALL_API TyndallStatus tyndall_sky_probe_coefficients(const TyndallSkyProbe* probe,
                                                         TyndallSkyCoefficients* coefficients);
TYNDALL_API TyndallStatus tyndall_sky_probe_cube(const TyndallSkyProbe* probe, TyndallSkyCube* cube);
TYNDALL_API TyndallStatus tyndall_sky_probe_memory(const TyndallSkyProbe* probe, TyndallMemoryUsage* memory);

#ifdef __cplusplus
}
#endif

#endif
