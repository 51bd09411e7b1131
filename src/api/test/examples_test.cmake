# Installs what a program needs to build on HVAS into an empty folder, builds the examples against it, and runs them.
set(prefix ${build}/examples_test/prefix)
set(examples ${build}/examples_test/build)
file(REMOVE_RECURSE ${build}/examples_test)

function(run)
  execute_process(COMMAND ${ARGN} OUTPUT_VARIABLE output ERROR_VARIABLE output RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    message(FATAL_ERROR "${ARGN}\nended with ${status}:\n${output}")
  endif()
  set(output "${output}" PARENT_SCOPE)
endfunction()

foreach(component runtime sdk)
  run(${CMAKE_COMMAND} --install ${build} --prefix ${prefix} --component ${component})
endforeach()
run(${CMAKE_COMMAND} -S ${source}/examples -B ${examples} -G ${generator} -D CMAKE_PREFIX_PATH=${prefix} -D CMAKE_BUILD_TYPE=Release
    -D CMAKE_CXX_COMPILER=${compiler} -D CMAKE_CXX_COMPILER_LAUNCHER=${launcher} -D CMAKE_CXX_FLAGS=-Wall\ -Wextra\ -Werror)
run(${CMAKE_COMMAND} --build ${examples})

# example(<name> <what its output has to match> argument...)
function(example name expected)
  run(${examples}/${name} ${ARGN})
  if(NOT output MATCHES "${expected}")
    message(FATAL_ERROR "${name} printed\n${output}\nand not ${expected}")
  endif()
  message(STATUS "${name}: ${CMAKE_MATCH_0}")
endfunction()

set(bushing ${source}/products/bushing.step)
example(assemble_product "3 of 3 parts in place, digest 843a85d5bc4c76e4176ead5c0adc7136" ${bushing})
example(inspect_mates "H7/[a-z][0-9].*mates, 3 parts" ${bushing})
example(plan_order "order 1, cost [0-9.]+: " ${source}/products/gear_pump.step)
example(record_and_replay "[0-9]+ ticks, bit for bit" ${bushing} ${build}/examples_test/session.hvasrec)
example(own_hand "in its place after [0-9.]+ s" ${bushing})

# Without their arguments, with empty ones, with one too many, and with a file that is not there, they say so.
# refuses(<name> <what its output has to match> argument...)
function(refuses name expected)
  execute_process(COMMAND ${examples}/${name} ${ARGN} OUTPUT_VARIABLE output ERROR_VARIABLE output RESULT_VARIABLE status)
  if(NOT status EQUAL 1 OR NOT output MATCHES "${expected}")
    message(FATAL_ERROR "${name} ${ARGN}\nended with ${status} and printed\n${output}\nand not ${expected}")
  endif()
endfunction()

foreach(name assemble_product inspect_mates own_hand plan_order record_and_replay)
  refuses(${name} "usage: [^\n]*${name} FILE")
  refuses(${name} "usage: [^\n]*${name} FILE" a b c)
  set(rest)
  if(name STREQUAL record_and_replay)
    set(rest ${build}/examples_test/none.hvasrec)
  endif()
  refuses(${name} "missing.step: " ${build}/missing.step ${rest})
endforeach()
file(WRITE ${build}/examples_test/one.stl "solid one
facet normal 0 0 -1\nouter loop\nvertex 0 0 0\nvertex 0 10 0\nvertex 10 0 0\nendloop\nendfacet
facet normal 0 -1 0\nouter loop\nvertex 0 0 0\nvertex 10 0 0\nvertex 0 0 10\nendloop\nendfacet
facet normal -1 0 0\nouter loop\nvertex 0 0 0\nvertex 0 0 10\nvertex 0 10 0\nendloop\nendfacet
facet normal 1 1 1\nouter loop\nvertex 10 0 0\nvertex 0 10 0\nvertex 0 0 10\nendloop\nendfacet
endsolid one\n")
refuses(own_hand "there is no second part" ${build}/examples_test/one.stl)
refuses(assemble_product "there is no driver" ${bushing} nonsense)
refuses(record_and_replay "." ${bushing} ${build}/no/such/folder/session.hvasrec)
