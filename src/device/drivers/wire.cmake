# Drivers that reach their devices by sockets, device files and plug-ins, and emulators of those.
find_package(Boost REQUIRED)

target_sources(hvas_device PRIVATE
  drivers/datagram_socket.cc drivers/evdev_node.cc drivers/gamepad.cc drivers/haply.cc drivers/haply_messages.cc
  drivers/network.cc drivers/network_protocol.cc drivers/plugin.cc drivers/polled_guard.cc drivers/rate_control.cc
  drivers/reopener.cc drivers/spacemouse.cc drivers/unix_socket.cc drivers/websocket.cc)
target_link_libraries(hvas_device PRIVATE OpenSSL::Crypto Boost::headers Threads::Threads ${CMAKE_DL_LIBS})
set_source_files_properties(drivers/websocket.cc PROPERTIES COMPILE_DEFINITIONS "BOOST_ALL_NO_LIB;BOOST_ERROR_CODE_HEADER_ONLY"
  COMPILE_OPTIONS "-Wno-conversion;-Wno-shadow;-Wno-double-promotion;-Wno-non-virtual-dtor")

target_sources(hvas_device_emulation PRIVATE
  emulation/gamepad_emulator.cc emulation/haply_server.cc emulation/network_client.cc emulation/plugin_emulator.cc
  emulation/rate_person.cc emulation/spacenav_server.cc emulation/wire_emulator.cc)
target_link_libraries(hvas_device_emulation PRIVATE nlohmann_json::nlohmann_json Threads::Threads ${CMAKE_DL_LIBS})

# The plug-in of the emulator, and the example of one in C, which need nothing of HVAS but a header.
add_library(hvas_emulated_plugin MODULE emulation/emulated_plugin.cc)
target_link_libraries(hvas_emulated_plugin PRIVATE hvas_settings)
set_target_properties(hvas_emulated_plugin PROPERTIES PREFIX "")
add_dependencies(hvas_device_emulation hvas_emulated_plugin)
set_source_files_properties(emulation/plugin_emulator.cc PROPERTIES COMPILE_DEFINITIONS
  "HVAS_EMULATED_PLUGIN=\"$<TARGET_FILE:hvas_emulated_plugin>\"")
add_library(simulated_handle MODULE plugin/example/simulated_handle.c)
target_include_directories(simulated_handle PRIVATE plugin)
target_compile_options(simulated_handle PRIVATE -Wall -Wextra -Wpedantic)
set_target_properties(simulated_handle PROPERTIES PREFIX "" C_STANDARD 11)

hvas_test(wire_faults_test SOURCES test/wire_faults_test.cc DEPS hvas::device_emulation)
