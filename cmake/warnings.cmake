# tyndall_warnings: what every target of ours compiles with. TYNDALL_WERROR is on in the ci preset.
add_library(tyndall_warnings INTERFACE)
target_compile_options(tyndall_warnings INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wnon-virtual-dtor -Wold-style-cast -Wcast-align
  -Woverloaded-virtual -Wimplicit-fallthrough -Wno-restrict
  $<$<BOOL:${TYNDALL_WERROR}>:-Werror>)
if(TYNDALL_SANITIZE)
  add_compile_options(-fsanitize=${TYNDALL_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${TYNDALL_SANITIZE})
endif()
