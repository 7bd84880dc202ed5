// Ends one expansion of a parameter list, so that the next can begin. No include guard on purpose.
#undef ENUM_BEGIN
#undef ENUM_VALUE
#undef ENUM_END
#undef GROUP_BEGIN
#undef GROUP_END
#undef PARAM_FLOAT
#undef PARAM_UINT
#undef PARAM_VEC3
#undef PARAM_COLOR
#undef PARAM_DVEC3
#undef PARAM_UVEC4
#undef PARAM_FLAG
#undef PARAM_ENUM
#undef PARAM_STRING
