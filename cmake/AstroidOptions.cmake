# Flags that every target of the project shares, as one interface library: astroid::options.
add_library(astroid_options INTERFACE)
add_library(astroid::options ALIAS astroid_options)

# Bit-for-bit results on every x86-64-v2 processor: no fused multiply-add anywhere (docs/decisions/0002-determinism.md).
target_compile_options(astroid_options INTERFACE -march=x86-64-v2 -ffp-contract=off -fno-math-errno)
target_compile_options(astroid_options INTERFACE -Wall -Wextra -Wpedantic -Wconversion -Wshadow)
if(ASTROID_WARNINGS_AS_ERRORS)
  target_compile_options(astroid_options INTERFACE -Werror)
endif()
if(ASTROID_PCH AND CMAKE_CXX_COMPILER_ID STREQUAL "GNU")  # lets ccache see through precompiled headers
  target_compile_options(astroid_options INTERFACE -fpch-preprocess)
endif()
if(ASTROID_SANITIZER)
  target_compile_options(astroid_options INTERFACE -fsanitize=${ASTROID_SANITIZER} -fno-omit-frame-pointer)
  target_link_options(astroid_options INTERFACE -fsanitize=${ASTROID_SANITIZER})
endif()
if(ASTROID_COVERAGE)
  target_compile_options(astroid_options INTERFACE --coverage)
  target_link_options(astroid_options INTERFACE --coverage)
endif()
