# hvas_library(<room> SOURCES a.cc ... [DEPS hvas::x ...] [PRIVATE_DEPS ...]): the library of a room, alias hvas::<room>.
function(hvas_library name)
  cmake_parse_arguments(ARG "" "" "SOURCES;DEPS;PRIVATE_DEPS" ${ARGN})
  add_library(hvas_${name} STATIC ${ARG_SOURCES})
  add_library(hvas::${name} ALIAS hvas_${name})
  target_link_libraries(hvas_${name} PUBLIC hvas_settings ${ARG_DEPS} PRIVATE ${ARG_PRIVATE_DEPS})
endfunction()

# hvas_test(<name> SOURCES a_test.cc ... [DEPS ...] [LABELS ...] [TIMEOUT s]): one GoogleTest program, one ctest entry.
# Unit tests are fast and need no other room's data; label slower ones
# `e2e`, or `numeric` where they only compare figures, so that the sanitizer runs can leave them out.
function(hvas_test name)
  cmake_parse_arguments(ARG "" "TIMEOUT" "SOURCES;DEPS;LABELS" ${ARGN})
  add_executable(${name} ${ARG_SOURCES})
  target_link_libraries(${name} PRIVATE ${ARG_DEPS} GTest::gtest GTest::gtest_main)
  target_compile_definitions(${name} PRIVATE HVAS_SOURCE_DIR="${CMAKE_SOURCE_DIR}")
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
  set_tests_properties(${name} PROPERTIES LABELS "${ARG_LABELS}" TIMEOUT ${ARG_TIMEOUT})
endfunction()
