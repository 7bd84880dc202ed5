# tyndall_warnings: the warning options of all our targets. The ci preset sets TYNDALL_WERROR.
add_library(tyndall_warnings INTERFACE)
target_compile_options(tyndall_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wold-style-cast -Wcast-align
  -Woverloaded-virtual -Wimplicit-fallthrough $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>
  $<$<BOOL:${TYNDALL_WERROR}>:-Werror>)
if(TYNDALL_SANITIZE)
  add_compile_options(-fsanitize=${TYNDALL_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${TYNDALL_SANITIZE})
endif()
# For targets with precompiled headers. In these, GCC 12 no longer knows that a header is a system header, and reports its false
# warnings about the strings of the standard library.
set(tyndall_pch_warnings -Wno-array-bounds$<SEMICOLON>-Wno-stringop-overflow$<SEMICOLON>-Wno-stringop-overread)
