# Drivers that reach their devices by sockets, device files and plug-ins, and emulators of those.
find_package(Boost REQUIRED)

target_sources(hvas_device PRIVATE
  drivers/datagram_socket.cc drivers/evdev_node.cc drivers/gamepad.cc drivers/haply.cc drivers/haply_messages.cc
  drivers/network.cc drivers/network_protocol.cc drivers/plugin.cc drivers/polled_guard.cc drivers/rate_control.cc
  drivers/reopener.cc drivers/spacemouse.cc drivers/unix_socket.cc drivers/websocket.cc)
target_link_libraries(hvas_device PRIVATE OpenSSL::Crypto Boost::headers Threads::Threads ${CMAKE_DL_LIBS})
set_source_files_properties(drivers/websocket.cc PROPERTIES COMPILE_DEFINITIONS "BOOST_ALL_NO_LIB;BOOST_ERROR_CODE_HEADER_ONLY"
  COMPILE_OPTIONS "-Wno-conversion;-Wno-shadow;-Wno-double-promotion;-Wno-non-virtual-dtor")

target_sources(hvas_device PRIVATE
  emulation/gamepad_emulator.cc emulation/haply_server.cc emulation/network_client.cc emulation/plugin_emulator.cc
  emulation/rate_person.cc emulation/spacenav_server.cc emulation/wire_emulator.cc)
target_link_libraries(hvas_device PRIVATE nlohmann_json::nlohmann_json Threads::Threads ${CMAKE_DL_LIBS})

# The plug-in of the emulator, and the example of one in C, which need nothing of HVAS but a header.
add_library(hvas_emulated_plugin MODULE emulation/emulated_plugin.cc)
target_link_libraries(hvas_emulated_plugin PRIVATE hvas_settings)
set_target_properties(hvas_emulated_plugin PROPERTIES PREFIX "")
add_dependencies(hvas_device hvas_emulated_plugin)
set_source_files_properties(emulation/plugin_emulator.cc PROPERTIES COMPILE_DEFINITIONS
  "HVAS_EMULATED_PLUGIN=\"$<TARGET_FILE:hvas_emulated_plugin>\"")
add_library(simulated_handle MODULE plugin/example/simulated_handle.c)
target_include_directories(simulated_handle PRIVATE plugin)
target_compile_options(simulated_handle PRIVATE -Wall -Wextra -Wpedantic)
set_target_properties(simulated_handle PROPERTIES PREFIX "" C_STANDARD 11)

if(NOT HVAS_TESTS)
  return()
endif()

hvas_test(wire_faults_test SOURCES test/wire_faults_test.cc DEPS hvas::device)
hvas_test(network_test SOURCES test/network_test.cc DEPS hvas::device OpenSSL::Crypto)

# Plug-ins that have to be refused.
function(hvas_odd_plugin name)
  add_library(odd_plugin_${name} MODULE test/odd_plugin.c)
  target_include_directories(odd_plugin_${name} PRIVATE plugin)
  target_compile_definitions(odd_plugin_${name} PRIVATE ${ARGN})
  set_target_properties(odd_plugin_${name} PROPERTIES PREFIX "")
  add_dependencies(plugin_test odd_plugin_${name})
endfunction()
hvas_test(plugin_test SOURCES test/plugin_test.cc DEPS hvas::device ${CMAKE_DL_LIBS})
hvas_odd_plugin(none)
hvas_odd_plugin(version ODD_PLUGIN_VERSION=7)
hvas_odd_plugin(hole ODD_PLUGIN_VERSION=HVAS_DEVICE_PLUGIN_VERSION)
add_dependencies(plugin_test simulated_handle)
target_compile_definitions(plugin_test PRIVATE
  HVAS_EXAMPLE_PLUGIN="$<TARGET_FILE:simulated_handle>" HVAS_EMULATED_PLUGIN="$<TARGET_FILE:hvas_emulated_plugin>"
  HVAS_ODD_PLUGIN_NONE="$<TARGET_FILE:odd_plugin_none>" HVAS_ODD_PLUGIN_VERSION="$<TARGET_FILE:odd_plugin_version>"
  HVAS_ODD_PLUGIN_HOLE="$<TARGET_FILE:odd_plugin_hole>")
hvas_test(haply_test SOURCES test/haply_test.cc DEPS hvas::device)
hvas_test(rate_devices_test SOURCES test/rate_devices_test.cc DEPS hvas::device)
hvas_test(wire_live_test SOURCES test/wire_live_test.cc DEPS hvas::device LABELS unit thread release)
