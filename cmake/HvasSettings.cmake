# Language level, warnings and the flags that make runs repeatable, as interface targets.

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_EXPORT_COMPILE_COMMANDS ON)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)

option(HVAS_WERROR "Treat warnings as errors" OFF)
set(HVAS_SANITIZE "" CACHE STRING "Sanitizers, as in -fsanitize=")
set(HVAS_SANITIZE_NOT "" CACHE STRING "Checks of these sanitizers to leave out, as in -fno-sanitize=")

find_program(HVAS_CCACHE ccache)
if(HVAS_CCACHE)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${HVAS_CCACHE})
  set(CMAKE_C_COMPILER_LAUNCHER ${HVAS_CCACHE})
endif()
find_program(HVAS_LLD NAMES ld.lld-14 ld.lld)
if(HVAS_LLD)
  add_link_options(-fuse-ld=lld -B${PROJECT_BINARY_DIR}/linker)
  file(MAKE_DIRECTORY ${PROJECT_BINARY_DIR}/linker)
  file(CREATE_LINK ${HVAS_LLD} ${PROJECT_BINARY_DIR}/linker/ld.lld SYMBOLIC)
endif()

add_library(hvas_settings INTERFACE)
target_include_directories(hvas_settings INTERFACE ${PROJECT_SOURCE_DIR}/src)
# No contraction: the same source gives the same bits with every optimisation level and kernel.
target_compile_options(hvas_settings INTERFACE -ffp-contract=off -Wall -Wextra -Wpedantic -Wshadow
                       -Wconversion -Wdouble-promotion -Wnon-virtual-dtor)
# An index outside of its container, and a write over the end of the stack's frame, end the program in every build.
add_library(hvas_hardening INTERFACE)
target_compile_definitions(hvas_hardening INTERFACE _GLIBCXX_ASSERTIONS)
target_compile_options(hvas_hardening INTERFACE -fstack-protector-strong)
target_link_libraries(hvas_settings INTERFACE hvas_hardening)
if(HVAS_WERROR)
  target_compile_options(hvas_settings INTERFACE -Werror)
endif()
if(HVAS_SANITIZE)
  add_compile_options(-fsanitize=${HVAS_SANITIZE} -fno-omit-frame-pointer)
  if(HVAS_SANITIZE_NOT)
    add_compile_options(-fno-sanitize=${HVAS_SANITIZE_NOT})  # In vain before -fsanitize.
  endif()
  add_link_options(-fsanitize=${HVAS_SANITIZE})
endif()

find_package(Threads REQUIRED)
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(fmt REQUIRED)
if(HVAS_TESTS)
  find_package(GTest REQUIRED)
endif()
