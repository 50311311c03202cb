# Generates the access to shared records (tools/records) before anything is compiled.
file(GLOB_RECURSE headers CONFIGURE_DEPENDS RELATIVE ${PROJECT_SOURCE_DIR} ${PROJECT_SOURCE_DIR}/shaders/*.h)
set(ESPALIER_GENERATED ${PROJECT_BINARY_DIR}/generated)
set(ESPALIER_RECORDS "")
set(paths "")
foreach(header IN LISTS headers)
  list(APPEND paths ${PROJECT_SOURCE_DIR}/${header})
  file(STRINGS ${PROJECT_SOURCE_DIR}/${header} wishes REGEX "^RECORD_")
  if(wishes)
    get_filename_component(name ${header} NAME)
    list(APPEND ESPALIER_RECORDS ${ESPALIER_GENERATED}/records/${name})
  endif()
endforeach()
# A header that asks for the first time has to be noticed.
set_property(DIRECTORY APPEND PROPERTY CMAKE_CONFIGURE_DEPENDS ${paths})

file(GLOB sources CONFIGURE_DEPENDS ${PROJECT_SOURCE_DIR}/tools/records/*.cpp)
add_executable(espalier-records ${sources})
target_include_directories(espalier-records PRIVATE ${PROJECT_SOURCE_DIR})
target_compile_features(espalier-records PRIVATE cxx_std_20)
add_custom_command(
  OUTPUT ${ESPALIER_RECORDS}
  COMMAND espalier-records ${PROJECT_SOURCE_DIR} ${ESPALIER_GENERATED} ${headers}
  DEPENDS espalier-records ${paths}
  COMMENT "Generating the access to shared records" VERBATIM)
add_custom_target(espalier_generated DEPENDS ${ESPALIER_RECORDS})
