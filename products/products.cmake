# The example products: `make_products FOLDER` draws them; their files are kept beside the source.
# Not find_package: Debian's OpenCASCADE targets ask for libraries that drawing does not need.
find_path(HVAS_OCCT_INCLUDE Standard_Version.hxx PATH_SUFFIXES opencascade REQUIRED)
find_package(nlohmann_json REQUIRED)

set_source_files_properties(frame_500.cc gear_pump.cc loose_twelve.cc PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)  # Products, the same steps.
add_library(hvas_drawings STATIC bushing.cc frame_500.cc gear.cc gear_pump.cc gear_pump_parts.cc loose_twelve.cc nut_bolt.cc peg_hole.cc relations.cc snap_joint.cc solid.cc tools.cc truth.cc write_step.cc)
target_include_directories(hvas_drawings PUBLIC ${CMAKE_CURRENT_SOURCE_DIR})
target_include_directories(hvas_drawings SYSTEM PUBLIC ${HVAS_OCCT_INCLUDE})
target_link_libraries(hvas_drawings PUBLIC hvas_settings fmt::fmt nlohmann_json::nlohmann_json
                      TKXDESTEP TKSTEP TKSTEPAttr TKSTEPBase TKXSBase TKXCAF TKLCAF TKCDF TKBO TKFillet TKPrim TKShHealing TKTopAlgo
                      TKGeomAlgo TKGeomBase TKBRep TKG3d TKMath TKernel)

add_executable(make_products make_products.cc)
target_link_libraries(make_products PRIVATE hvas_drawings)

# Not `unit`: the work is OpenCASCADE's, in which sanitizers see nothing.
hvas_test(products_test SOURCES test/products_test.cc DEPS hvas_drawings LABELS e2e)
