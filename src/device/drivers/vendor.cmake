# Drivers that load vendors' libraries when the program runs, and libraries that stand in for them.

target_sources(hvas_device PRIVATE
  drivers/dynamic_library.cc drivers/force_dimension.cc drivers/limit_wrench.cc drivers/openhaptics.cc drivers/usb_nodes.cc
  drivers/vendor_device.cc drivers/virtuose.cc)
target_link_libraries(hvas_device PRIVATE Threads::Threads ${CMAKE_DL_LIBS})

set(HVAS_STUB_FOLDER ${CMAKE_CURRENT_BINARY_DIR}/emulation)
target_sources(hvas_device PRIVATE emulation/library_emulator.cc)
set_source_files_properties(emulation/library_emulator.cc PROPERTIES
  COMPILE_DEFINITIONS HVAS_STUB_FOLDER="${HVAS_STUB_FOLDER}")

# hvas_stub(<target> <file name> <folder> <source>): a library with the vendor's file name, that
# exports the vendor's functions and nothing else.
function(hvas_stub name file folder source)
  add_library(${name} MODULE ${source})
  set_target_properties(${name} PROPERTIES
    PREFIX "" SUFFIX "" OUTPUT_NAME ${file} LIBRARY_OUTPUT_DIRECTORY ${folder}
    CXX_VISIBILITY_PRESET hidden VISIBILITY_INLINES_HIDDEN ON SKIP_BUILD_RPATH ON)
  target_link_libraries(${name} PRIVATE hvas_settings hvas_spatial)
  if(HVAS_SANITIZE)
    # The types of an EmulatedPort are told apart by addresses, which hidden symbols have twice.
    target_compile_options(${name} PRIVATE -fno-sanitize=vptr)
  endif()
  add_dependencies(hvas_device ${name})
endfunction()

hvas_stub(hvas_stub_openhaptics libHD.so ${HVAS_STUB_FOLDER} emulation/stub_openhaptics.cc)
hvas_stub(hvas_stub_force_dimension libdrd.so ${HVAS_STUB_FOLDER} emulation/stub_force_dimension.cc)
hvas_stub(hvas_stub_virtuose virtuoseAPI.so ${HVAS_STUB_FOLDER} emulation/stub_virtuose.cc)

# What goes wrong with libraries: one of an old version, and one that needs what is not found.
hvas_stub(hvas_stub_virtuose3 virtuoseAPI.so ${HVAS_STUB_FOLDER}/version3 emulation/stub_virtuose3.cc)
add_library(hvas_stub_dependency SHARED emulation/stub_dependency.cc)
set_target_properties(hvas_stub_dependency PROPERTIES
  OUTPUT_NAME hvas_missing LIBRARY_OUTPUT_DIRECTORY ${HVAS_STUB_FOLDER}/unseen)
hvas_stub(hvas_stub_needy libHD.so ${HVAS_STUB_FOLDER}/needy emulation/stub_needy.cc)
target_link_libraries(hvas_stub_needy PRIVATE hvas_stub_dependency)

if(NOT HVAS_TESTS)
  return()
endif()

hvas_test(library_faults_test SOURCES test/library_faults_test.cc DEPS hvas::device)
hvas_test(library_loading_test SOURCES test/library_loading_test.cc DEPS hvas::device)
hvas_test(openhaptics_test SOURCES test/openhaptics_test.cc DEPS hvas::device)
hvas_test(force_dimension_test SOURCES test/force_dimension_test.cc DEPS hvas::device)
hvas_test(virtuose_test SOURCES test/virtuose_test.cc DEPS hvas::device)
hvas_test(library_live_test SOURCES test/library_live_test.cc DEPS hvas::device
          LABELS "unit;thread;release")
# Without label `unit`: the sanitizers end a process in ways of their own.
hvas_test(process_end_test SOURCES test/process_end_test.cc DEPS hvas::device LABELS e2e)
