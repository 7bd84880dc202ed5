// The map projections of the planet around a view, as shaders read them (std430): see
// src/scene/description/map_projection.hpp for the map projections and src/scene/view/local_frame.hpp for the local
// frame. Filled by src/scene/view/local_frame.cpp.

// The origin of the local frame in one map projection.
struct ProjectionLink {
  ivec2 units;        // its place on the map [1/64 m], rounded down
  vec2 rest_m;        // what was rounded off
  vec2 radial;        // unit vector from the map projection's centre to it, on the map (x east, z south)
  vec2 local_radial;  // the same direction in x and z of the local frame
  float radius_m;     // its distance from the map projection's centre on the map
  float sine;         // of its arc from the map projection's centre
  float cosine;
  float unused;
};

struct MapProjections {
  ProjectionLink links[6];
  vec3 world_x;  // the world's axes in the local frame
  float planet_radius_m;
  vec3 world_y;
  uint own;  // the map projection that the terrain's grid lies on
  vec3 world_z;
  float unused;
};
