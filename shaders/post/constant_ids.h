// The specialisation constant of tone mapping: GLSL declares it by its id, and src/post/tonemap.cpp sets it under the
// same name. No other shader of the program has a constant with this id.
#ifndef TYNDALL_POST_CONSTANT_IDS
#define TYNDALL_POST_CONSTANT_IDS

const uint kOperatorId = 48u;  // post::Operator

#endif
