// The positions of slices and samples in the picture, after Yusov, "High Performance Outdoor Light Scattering Using
// Epipolar Sampling" (2013), section 1.2. There are two differences. Slices end only on the sides of the border where
// lines from the epipole leave the picture, and they are evenly spaced along these sides. The epipole is given in
// homogeneous coordinates, so a sun at a right angle to the view needs no special case.
#ifndef TYNDALL_SLICES_GLSL
#define TYNDALL_SLICES_GLSL

#include "epipolar/constants.glsl"

// Returns a direction that points away from the epipole. Its length is arbitrary but exceeds 1e-20.
vec2 direction_from_epipole(vec2 position) {
  vec2 d = position * epipolar.sun_w - vec2(epipolar.sun_x, epipolar.sun_y);
  return max(abs(d.x), abs(d.y)) > 1e-20 ? d : vec2(epipolar.fallback_x, epipolar.fallback_y);
}

vec2 away_from_epipole(vec2 position) {
  vec2 d = direction_from_epipole(position);
  return normalize(d / max(abs(d.x), abs(d.y)));
}

vec2 epipole() { return vec2(epipolar.sun_x, epipolar.sun_y) / epipolar.sun_w; }

vec2 border_low() { return vec2(0.5); }
vec2 border_high() { return vec2(float(frame.width), float(frame.height)) - 0.5; }

// Returns the distance from a position along a direction to the border. `across`: the line leaves the picture on the
// left or right side.
float distance_to_border(vec2 position, vec2 direction, out bool across) {
  vec2 gap = vec2(direction.x > 0.0 ? border_high().x - position.x : position.x - border_low().x,
                  direction.y > 0.0 ? border_high().y - position.y : position.y - border_low().y);
  vec2 t = max(gap, vec2(0.0)) / max(abs(direction), vec2(1e-12));
  across = t.x <= t.y;
  return min(t.x, t.y);
}

// Returns the position on the border at a distance along the perimeter.
vec2 border_position(float along) {
  vec2 low = border_low();
  vec2 high = border_high();
  vec2 size = high - low;
  vec2 position = low;
  // Find the side that contains the position. Rounding may place it on no side; then take the side that ends closest
  // before it.
  float min_beyond = 1e30;
  vec4 starts = vec4(epipolar.left_start, epipolar.bottom_start, epipolar.right_start, epipolar.top_start);
  for (int side = 0; side < 4; ++side) {
    float start = starts[side];
    float x = along - start;
    float length_px = side == 0 || side == 2 ? size.y : size.x;
    float beyond = max(x - length_px, 0.0);
    if (start >= 0.0 && x >= 0.0 && beyond <= min_beyond) {
      min_beyond = beyond;
      x = min(x, length_px);
      position = side == 0   ? vec2(low.x, low.y + x)
                 : side == 1 ? vec2(low.x + x, high.y)
                 : side == 2 ? vec2(high.x, high.y - x)
                             : vec2(high.x - x, low.y);
    }
  }
  return position;
}

// The side of the border where a line from the epipole leaves the picture. The distance along the perimeter is offset +
// sign * c, where c is the coordinate along the side (y if `upright`, otherwise x).
struct Side {
  bool upright;  // left or right
  float edge;    // the coordinate of the side on the other axis
  float sign;
  float offset;
};

// Returns the side where the line from the epipole through a position leaves the picture.
Side side_behind(vec2 position) {
  vec2 d = direction_from_epipole(position);
  vec2 low = border_low();
  vec2 high = border_high();
  bool right = d.x > 0.0;
  bool down = d.y > 0.0;
  vec2 edge = vec2(right ? high.x : low.x, down ? high.y : low.y);
  vec2 gap =
      max(vec2(right ? edge.x - position.x : position.x - edge.x, down ? edge.y - position.y : position.y - edge.y),
          vec2(0.0));
  Side side;
  side.upright = gap.x * abs(d.y) <= gap.y * abs(d.x);
  side.edge = side.upright ? edge.x : edge.y;
  side.sign = (side.upright ? right : !down) ? -1.0 : 1.0;
  float start = side.upright ? (right ? epipolar.right_start : epipolar.left_start)
                             : (down ? epipolar.bottom_start : epipolar.top_start);
  float first = side.upright ? (right ? high.y : low.y) : (down ? low.x : high.x);
  side.offset = max(start, 0.0) - side.sign * first;
  return side;
}

// Returns the position of a line from the epipole among the slices: the index of the slice below it plus the fraction
// of the way to the next slice. `side`: the side where the line ends, or that of a neighbouring pixel.
float slice_coordinate(vec2 position, Side side) {
  const float kLevel = 1e-9;  // a line with a smaller component across the side is parallel to it
  vec2 d = direction_from_epipole(position);
  vec2 at = side.upright ? position : position.yx;
  d = side.upright ? d : d.yx;
  float exit = at.y + (side.edge - at.x) * d.y / (abs(d.x) > kLevel ? d.x : kLevel);
  float count = float(epipolar.closed != 0u ? epipolar.slices : epipolar.slices - 1u);
  return clamp((side.offset + side.sign * exit) * (count / epipolar.perimeter), 0.0, count);
}

// Returns the largest change of slice_coordinate() within a distance `reach` along both axes [pixels].
float slices_within(vec2 position, Side side, vec2 reach) {
  vec2 d = direction_from_epipole(position);
  float sun = side.upright ? epipolar.sun_x : epipolar.sun_y;
  d = side.upright ? d : d.yx;
  reach = side.upright ? reach : reach.yx;
  float across = max(abs(d.x), 1e-9);
  // The ratio of the distance between two slices at the border to their distance at this position.
  float widening = abs(side.edge * epipolar.sun_w - sun) / across;
  float count = float(epipolar.closed != 0u ? epipolar.slices : epipolar.slices - 1u);
  return widening * (reach.y + reach.x * abs(d.y) / across) * (count / epipolar.perimeter);
}

float slice_coordinate(vec2 position) { return slice_coordinate(position, side_behind(position)); }

vec2 sample_position(EpipolarSlice slice, uint i) { return slice.line.xy + slice.stride * float(i); }

#endif
