// Where slices and samples lie in the picture. Include after declaring
//   buffer epipolar_block { EpipolarConstants epipolar; };  and  frame
// After Yusov, "High Performance Outdoor Light Scattering Using Epipolar Sampling" (2013), section 1.2, with two
// differences: the slices end only on sides that rays from the epipole reach from within the picture, evenly
// spread over their pixels; and the epipole is homogeneous, so that a sun at right angles to the view is nothing
// special.
#ifndef TYNDALL_SLICES_GLSL
#define TYNDALL_SLICES_GLSL

// Unit vector away from the epipole.
vec2 away_from_epipole(vec2 position) {
  vec2 d = position * epipolar.sun_w - vec2(epipolar.sun_x, epipolar.sun_y);
  float size = max(abs(d.x), abs(d.y));
  vec2 fallback = vec2(epipolar.fallback_x, epipolar.fallback_y);
  return normalize(size > 1e-20 ? d / size : fallback);
}

vec2 epipole() { return vec2(epipolar.sun_x, epipolar.sun_y) / epipolar.sun_w; }

vec2 border_low() { return vec2(0.5); }
vec2 border_high() { return vec2(float(frame.width), float(frame.height)) - 0.5; }

// Distance from a place in the picture along a direction to the border.
float distance_to_border(vec2 position, vec2 direction, out bool across) {
  vec2 gap = vec2(direction.x > 0.0 ? border_high().x - position.x : position.x - border_low().x,
                  direction.y > 0.0 ? border_high().y - position.y : position.y - border_low().y);
  vec2 t = max(gap, vec2(0.0)) / max(abs(direction), vec2(1e-12));
  across = t.x <= t.y;  // leaves through the left or right side
  return min(t.x, t.y);
}

// Place on the border at a distance along the perimeter.
vec2 border_place(float along) {
  vec2 low = border_low();
  vec2 high = border_high();
  vec2 size = high - low;
  vec2 place = low;
  // The side that holds it, or for want of one by rounding, ends closest before it.
  float least_beyond = 1e30;
  for (int side = 0; side < 4; ++side) {
    float start = epipolar.side_start[side];
    float x = along - start;
    float length_px = side == 0 || side == 2 ? size.y : size.x;
    float beyond = max(x - length_px, 0.0);
    if (start >= 0.0 && x >= 0.0 && beyond <= least_beyond) {
      least_beyond = beyond;
      x = min(x, length_px);
      place = side == 0   ? vec2(low.x, low.y + x)
              : side == 1 ? vec2(low.x + x, high.y)
              : side == 2 ? vec2(high.x, high.y - x)
                          : vec2(high.x - x, low.y);
    }
  }
  return place;
}

// The slices around the line from the epipole through a place: the lower one plus the part of the way to the next.
float slice_coordinate(vec2 position) {
  vec2 direction = away_from_epipole(position);
  bool across;
  float t = distance_to_border(position, direction, across);
  vec2 exit = position + t * direction;
  vec2 low = border_low();
  vec2 high = border_high();
  int side = across ? (direction.x > 0.0 ? 2 : 0) : (direction.y > 0.0 ? 1 : 3);
  float x = side == 0 ? exit.y - low.y : side == 1 ? exit.x - low.x : side == 2 ? high.y - exit.y : high.x - exit.x;
  float along = max(epipolar.side_start[side], 0.0) + max(x, 0.0);
  float count = float(epipolar.closed != 0u ? epipolar.slices : epipolar.slices - 1u);
  return clamp(along / epipolar.perimeter * count, 0.0, count);
}

vec2 sample_position(EpipolarSlice slice, uint i) {
  return vec2(slice.entry_x, slice.entry_y) + vec2(slice.stride_x, slice.stride_y) * float(i);
}

#endif
