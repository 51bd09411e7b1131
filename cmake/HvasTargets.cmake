# Code that reads and writes texts, and that of tests, which call the rooms, takes a quarter less time to compile at -O1 than
# at -O2, and is not what takes time when it runs.
set(HVAS_LIGHT_OPTIMISATION)
if(CMAKE_BUILD_TYPE STREQUAL RelWithDebInfo)
  set(HVAS_LIGHT_OPTIMISATION -O1)
endif()
# What most sources include of others' headers, compiled once for rooms, for rooms of texts and for tests. A source must not
# rely on it: the preset `clang` compiles each source by itself without it.
option(HVAS_PRECOMPILED "Compile the headers of libraries once" OFF)
if(HVAS_PRECOMPILED)
  file(CONFIGURE OUTPUT ${CMAKE_BINARY_DIR}/precompiled.cc CONTENT "int main() {}\n")
  set(HVAS_PRECOMPILED_HEADERS
      <algorithm> <array> <atomic> <chrono> <cmath> <cstdint> <filesystem> <fstream> <functional> <map> <memory> <numbers>
      <numeric> <optional> <set> <span> <sstream> <string> <string_view> <thread> <unordered_map> <utility> <vector>
      <Eigen/Core> <Eigen/Geometry> <fmt/format.h> <nlohmann/json.hpp> <tl/expected.hpp>)
  # A library and programs, because their code is not placed alike (-fPIC, -fPIE); `runs` is not optimised.
  add_library(hvas_precompiled_rooms OBJECT EXCLUDE_FROM_ALL ${CMAKE_BINARY_DIR}/precompiled.cc)
  add_library(hvas_precompiled_texts OBJECT EXCLUDE_FROM_ALL ${CMAKE_BINARY_DIR}/precompiled.cc)
  add_executable(hvas_precompiled_tests EXCLUDE_FROM_ALL ${CMAKE_BINARY_DIR}/precompiled.cc)
  add_executable(hvas_precompiled_runs EXCLUDE_FROM_ALL ${CMAKE_BINARY_DIR}/precompiled.cc)
  foreach(users rooms texts tests runs)
    target_link_libraries(hvas_precompiled_${users} PRIVATE hvas_settings Eigen3::Eigen fmt::fmt)
    target_precompile_headers(hvas_precompiled_${users} PRIVATE ${HVAS_PRECOMPILED_HEADERS})
  endforeach()
  foreach(users tests runs)
    target_link_libraries(hvas_precompiled_${users} PRIVATE GTest::gtest)
    target_precompile_headers(hvas_precompiled_${users} PRIVATE <gtest/gtest.h>)
  endforeach()
  foreach(users texts tests)
    target_compile_options(hvas_precompiled_${users} PRIVATE ${HVAS_LIGHT_OPTIMISATION})
  endforeach()
  target_precompile_headers(hvas_precompiled_texts PRIVATE <CLI/CLI.hpp>)
  target_compile_options(hvas_precompiled_runs PRIVATE -O0)
endif()

# hvas_precompiled(<target> rooms|texts|tests|runs): what a target takes its precompiled headers from.
function(hvas_precompiled target users)
  if(HVAS_PRECOMPILED)
    target_precompile_headers(${target} REUSE_FROM hvas_precompiled_${users})
  endif()
endfunction()

# hvas_library(<room> SOURCES a.cc ... [DEPS hvas::x ...] [PRIVATE_DEPS ...] [TEXTS]): the library of a room, alias
# hvas::<room>. One with TEXTS reads and writes texts, and calls others for what takes time.
function(hvas_library name)
  cmake_parse_arguments(ARG "TEXTS" "" "SOURCES;DEPS;PRIVATE_DEPS" ${ARGN})
  add_library(hvas_${name} STATIC ${ARG_SOURCES})
  add_library(hvas::${name} ALIAS hvas_${name})
  target_link_libraries(hvas_${name} PUBLIC hvas_settings ${ARG_DEPS} PRIVATE ${ARG_PRIVATE_DEPS})
  if(ARG_TEXTS)
    target_compile_options(hvas_${name} PRIVATE ${HVAS_LIGHT_OPTIMISATION})
    hvas_precompiled(hvas_${name} texts)
  else()
    hvas_precompiled(hvas_${name} rooms)
  endif()
endfunction()

# hvas_symbols_apart(<program>): leaves the debug information beside the program, in <program>.debug, where gdb and
# addr2line find it; it is most of the program's size.
function(hvas_symbols_apart name)
  if(CMAKE_BUILD_TYPE STREQUAL RelWithDebInfo AND CMAKE_OBJCOPY)
    add_custom_command(TARGET ${name} POST_BUILD
      COMMAND ${CMAKE_OBJCOPY} --only-keep-debug $<TARGET_FILE:${name}> $<TARGET_FILE:${name}>.debug
      COMMAND ${CMAKE_OBJCOPY} --strip-unneeded --add-gnu-debuglink=$<TARGET_FILE:${name}>.debug $<TARGET_FILE:${name}>
      VERBATIM)
  endif()
endfunction()

# hvas_compile_alone(a.cc ...): sources that are not joined with others of their target: those that hold nothing but
# real-time code, so that tools/lint/rt_symbols.py can ask of each what it names, and those that have the same local names
# by design, as the drivers have.
function(hvas_compile_alone)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# hvas_test(<name> SOURCES a_test.cc ... [DEPS ...] [LABELS ...] [TIMEOUT s] [COST s] [RUNS]): one GoogleTest program, one
# ctest entry. Those of the highest cost begin first, so that no long one is left to run alone. Unit tests are fast and need no other room's data; label slower ones
# `e2e`, or `numeric` where they only compare figures, so that the sanitizer runs can leave them out. A test with RUNS only
# starts programs or calls rooms, which do the work: it is not optimised.
function(hvas_test name)
  cmake_parse_arguments(ARG "RUNS" "TIMEOUT;COST" "SOURCES;DEPS;LABELS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_DEPS} GTest::gtest GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE HVAS_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
  if(ARG_RUNS AND NOT HVAS_SANITIZE)
    target_compile_options(${name} PRIVATE -O0)
    hvas_precompiled(${name} runs)
  else()
    target_compile_options(${name} PRIVATE ${HVAS_LIGHT_OPTIMISATION})
    hvas_precompiled(${name} tests)
  endif()
  if(NOT ARG_LABELS)
    set(ARG_LABELS unit)
  endif()
  if(NOT ARG_TIMEOUT)
    set(ARG_TIMEOUT 300)
  endif()
  if(HVAS_SANITIZE)
    math(EXPR ARG_TIMEOUT "4 * ${ARG_TIMEOUT}")
  endif()
  add_test(NAME ${name} COMMAND ${name})
  if(ARG_COST)
    set_tests_properties(${name} PROPERTIES COST ${ARG_COST})
  endif()
  get_filename_component(room ${CMAKE_CURRENT_SOURCE_DIR} NAME)
  set_tests_properties(${name} PROPERTIES LABELS "${ARG_LABELS};room_${room}" TIMEOUT ${ARG_TIMEOUT})
endfunction()
