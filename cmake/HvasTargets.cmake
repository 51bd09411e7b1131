# How the sources of a target are compiled, by what they are: `rooms`; `texts`, code that reads and writes texts; `tests`, which
# call the rooms; `runs`, tests that only start programs or call rooms that do the work. Texts and tests take a quarter less
# time to compile at -O1 than at -O2, and are not what takes time when they run.
set(HVAS_KINDS rooms texts)
if(HVAS_TESTS)
  list(APPEND HVAS_KINDS tests runs)
endif()
set(HVAS_OPTIONS_rooms)
if(NOT HVAS_SANITIZE)
  set(HVAS_OPTIONS_rooms $<$<CONFIG:Release>:-U_FORTIFY_SOURCE> $<$<CONFIG:Release>:-D_FORTIFY_SOURCE=2>)  # Needs optimisation.
endif()
set(HVAS_OPTIONS_texts ${HVAS_OPTIONS_rooms} $<$<CONFIG:Release>:-O1>)
set(HVAS_OPTIONS_tests ${HVAS_OPTIONS_texts})
set(HVAS_OPTIONS_runs -O0)

# What most sources include of others' headers, compiled once for each kind. A source must not rely on it: the preset `clang`
# compiles each source by itself without it.
option(HVAS_PRECOMPILED "Compile the headers of libraries once" OFF)
if(HVAS_PRECOMPILED)
  file(CONFIGURE OUTPUT ${PROJECT_BINARY_DIR}/precompiled.cc CONTENT "int main() {}\n")
  set(HVAS_PRECOMPILED_HEADERS
      <algorithm> <array> <atomic> <chrono> <cmath> <cstdint> <filesystem> <fstream> <functional> <map> <memory> <numbers>
      <numeric> <optional> <set> <span> <sstream> <string> <string_view> <thread> <unordered_map> <utility> <vector>
      <Eigen/Core> <Eigen/Geometry> <fmt/format.h> <nlohmann/json.hpp> <tl/expected.hpp>)
  # Libraries and programs, because their code is not placed alike (-fPIC, -fPIE).
  foreach(kind rooms texts)
    add_library(hvas_precompiled_${kind} OBJECT EXCLUDE_FROM_ALL ${PROJECT_BINARY_DIR}/precompiled.cc)
  endforeach()
  if(HVAS_TESTS)
    foreach(kind tests runs)
      add_executable(hvas_precompiled_${kind} EXCLUDE_FROM_ALL ${PROJECT_BINARY_DIR}/precompiled.cc)
      target_link_libraries(hvas_precompiled_${kind} PRIVATE GTest::gtest)
    endforeach()
  endif()
  foreach(kind ${HVAS_KINDS})
    target_link_libraries(hvas_precompiled_${kind} PRIVATE hvas_settings Eigen3::Eigen fmt::fmt)
    target_compile_options(hvas_precompiled_${kind} PRIVATE ${HVAS_OPTIONS_${kind}})
    target_precompile_headers(hvas_precompiled_${kind} PRIVATE ${HVAS_PRECOMPILED_HEADERS})
  endforeach()
  target_precompile_headers(hvas_precompiled_texts PRIVATE <CLI/CLI.hpp>)
  if(HVAS_TESTS)
    target_precompile_headers(hvas_precompiled_tests PRIVATE <gtest/gtest.h>)
    target_precompile_headers(hvas_precompiled_runs PRIVATE <gtest/gtest.h>)
  endif()
endif()

# hvas_compile_as(<target> rooms|texts|tests|runs): the optimisation and the precompiled headers of this kind.
function(hvas_compile_as target kind)
  target_compile_options(${target} PRIVATE ${HVAS_OPTIONS_${kind}})
  if(HVAS_PRECOMPILED)
    target_precompile_headers(${target} REUSE_FROM hvas_precompiled_${kind})
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
    hvas_compile_as(hvas_${name} texts)
  else()
    hvas_compile_as(hvas_${name} rooms)
  endif()
endfunction()

# hvas_compile_alone(a.cc ...): sources that are not joined with others of their target: those that hold nothing but
# real-time code, so that tools/lint/rt_symbols.py can ask of each what it names, and those that have the same local names
# by design, as the drivers have.
function(hvas_compile_alone)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# hvas_list_suites(<out> a_test.cc ...): the test suites of these sources, as a filter of GoogleTest.
function(hvas_list_suites out)
  set(filter)
  foreach(source ${ARGN})
    set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/${source})
    file(STRINGS ${source} lines REGEX "^(TYPED_)?TEST(_[FP])?\\(")
    foreach(line ${lines})
      string(REGEX REPLACE "^[A-Z_]*\\(([A-Za-z0-9_]+),.*" "\\1" suite "${line}")
      list(APPEND filter "${suite}.*" "*/${suite}.*" "${suite}/*")
    endforeach()
  endforeach()
  list(REMOVE_DUPLICATES filter)
  list(JOIN filter ":" filter)
  set(${out} "${filter}" PARENT_SCOPE)
endfunction()

# hvas_test(<name> SOURCES a_test.cc ... [IN program] [DEPS ...] [LABELS ...] [TIMEOUT s] [COST s] [RUNS]): one ctest entry, and
# its GoogleTest program. With IN the entry is a part of a program that another test names, which stands after all its
# parts and runs what they do not: a program takes seconds to compile beside what is in it. Those of the highest cost begin
# first, so that no long one is left to run alone. Labels say where a test runs (see ./test): `unit`, the default, is fast
# and needs no other room's data; `e2e` takes longer, or starts programs; `numeric` only compares figures, so that
# sanitizers have nothing to see; `thread` runs under the thread sanitizer; `smoke` runs after every change; `release` in
# `./test all` only. A test with RUNS only starts programs or calls rooms, which do the work: it is not optimised.
function(hvas_test name)
  cmake_parse_arguments(ARG "RUNS" "IN;TIMEOUT;COST" "SOURCES;DEPS;LABELS" ${ARGN})
  set(program ${name})
  if(ARG_IN)
    set(program ${ARG_IN})
  endif()
  if(NOT TARGET ${program})
    add_executable(${program})
    target_link_libraries(${program} PRIVATE GTest::gtest GTest::gtest_main)
    target_compile_definitions(${program} PRIVATE HVAS_SOURCE_DIR="${PROJECT_SOURCE_DIR}")
    if(ARG_RUNS AND NOT HVAS_SANITIZE)
      hvas_compile_as(${program} runs)
    else()
      hvas_compile_as(${program} tests)
    endif()
  endif()
  target_sources(${program} PRIVATE ${ARG_SOURCES})
  target_link_libraries(${program} PRIVATE ${ARG_DEPS})
  set(filter "--gtest_filter=-*ReleaseTest.*")
  if(ARG_IN)
    hvas_list_suites(suites ${ARG_SOURCES})
    set_property(TARGET ${program} APPEND PROPERTY HVAS_PARTS "${suites}")
    set(filter "--gtest_filter=${suites}:-*ReleaseTest.*")
    add_custom_target(${name} DEPENDS ${program})  # Every test can be built by its name.
  else()
    get_target_property(parts ${program} HVAS_PARTS)
    if(parts)
      list(JOIN parts ":" parts)
      set(filter "--gtest_filter=-${parts}:*ReleaseTest.*")
    endif()
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
  add_test(NAME ${name} COMMAND ${program} ${filter})
  if(ARG_COST)
    set_tests_properties(${name} PROPERTIES COST ${ARG_COST})
  endif()
  get_filename_component(room ${CMAKE_CURRENT_SOURCE_DIR} NAME)
  set_tests_properties(${name} PROPERTIES LABELS "${ARG_LABELS};room_${room}" TIMEOUT ${ARG_TIMEOUT})
endfunction()

# hvas_release_tests(<name> <program> <filter>): those of a program's tests that only `./test all` runs, a minute or more each,
# as a ctest entry of their own. Their suites are called ...ReleaseTest, and the filter chooses some of them.
function(hvas_release_tests name program filter)
  add_test(NAME ${name} COMMAND ${program} --gtest_filter=${filter})
  get_filename_component(room ${CMAKE_CURRENT_SOURCE_DIR} NAME)
  set_tests_properties(${name} PROPERTIES LABELS "e2e;release;room_${room}" TIMEOUT 1200)
endfunction()
