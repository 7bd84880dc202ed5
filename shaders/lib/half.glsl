// Half precision, the format of images and of packed numbers.
#ifndef TYNDALL_LIB_HALF
#define TYNDALL_LIB_HALF

// The largest number. Larger ones would be stored as infinity, or as NaN by SwiftShader.
const float kLargestHalf = 65504.0;

#endif
