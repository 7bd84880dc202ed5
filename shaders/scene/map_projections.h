// The planet's map projections for one view, as shaders read them (std430): see
// src/scene/description/map_projection.hpp for the projections and src/scene/view/local_frame.hpp for the local frame.
// src/scene/view/local_frame.cpp fills them.

// The origin of the local frame in one map projection.
struct ProjectionLink {
  ivec2 units;        // its position on the map [1/64 m], rounded down
  vec2 rest_m;        // the remainder of the rounding
  vec2 radial;        // unit vector from the projection's centre to it, on the map (x east, z south)
  vec2 local_radial;  // the same direction in x and z of the local frame
  float radius_m;     // its distance from the map projection's centre on the map
  float sine;         // sine of its arc from the projection's centre
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
