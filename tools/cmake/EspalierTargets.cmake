# What every target of Espalier shares: language level, warnings, sanitizers, where programs land.

option(ESPALIER_SANITIZE "Build with AddressSanitizer and UndefinedBehaviorSanitizer" OFF)

set(CMAKE_CXX_STANDARD 20)
set(CMAKE_CXX_STANDARD_REQUIRED ON)
set(CMAKE_CXX_EXTENSIONS OFF)
set(CMAKE_POSITION_INDEPENDENT_CODE ON)
set(CMAKE_CXX_VISIBILITY_PRESET hidden)
set(CMAKE_RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/bin)
set(CMAKE_LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/lib)

find_program(CCACHE_PROGRAM ccache)
if(CCACHE_PROGRAM)
  set(CMAKE_CXX_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
  set(CMAKE_C_COMPILER_LAUNCHER ${CCACHE_PROGRAM})
endif()

if(ESPALIER_SANITIZE)
  # GCC 12 takes what std::regex holds for unset where that is instrumented.
  add_compile_options(-fsanitize=address,undefined -fno-sanitize-recover=undefined -fno-omit-frame-pointer
                      -Wno-maybe-uninitialized)
  add_link_options(-fsanitize=address,undefined)
endif()

option(ESPALIER_THREADS "Build with ThreadSanitizer (see tools/check threads)" OFF)
if(ESPALIER_THREADS)
  add_compile_options(-fsanitize=thread -fno-omit-frame-pointer)
  add_link_options(-fsanitize=thread)
endif()

option(ESPALIER_FUZZ "Instrument everything for libFuzzer (clang only; see tools/fuzz)" OFF)
if(ESPALIER_FUZZ)
  add_compile_options(-O1 -g1 -fsanitize=fuzzer-no-link,address,undefined -fno-sanitize-recover=undefined)
  add_compile_definitions(FUZZING_BUILD_MODE_UNSAFE_FOR_PRODUCTION)
  add_link_options(-fsanitize=address,undefined)
endif()

# The kernels' arithmetic is compiled for GPU and CPU; contraction into fused operations would let them differ.
add_compile_options(-ffp-contract=off)

# For files that can't be compiled together with others where CMAKE_UNITY_BUILD is on (the release preset): those for
# which a header of theirs says something else than for others, and those that are wanted as objects of their own.
function(espalier_apart)
  set_source_files_properties(${ARGN} PROPERTIES SKIP_UNITY_BUILD_INCLUSION ON)
endfunction()

# Other compilers than ours warn of other things, which is no reason to refuse a user's build.
option(ESPALIER_WARNINGS_AS_ERRORS "A warning ends the build (tools/check)" OFF)
if(ESPALIER_WARNINGS_AS_ERRORS)
  set(ESPALIER_WERROR -Werror)  # for C++ compilers and for glslc
endif()

function(espalier_defaults target)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wshadow
    ${ESPALIER_WERROR}
    $<$<CXX_COMPILER_ID:GNU>:-Wno-restrict>)  # GCC 12 warns of std::string falsely
  target_compile_definitions(${target} PRIVATE ESPALIER_VERSION="${PROJECT_VERSION}")
  target_include_directories(${target} PRIVATE ${PROJECT_SOURCE_DIR} ${ESPALIER_GENERATED})
  add_dependencies(${target} espalier_generated)
endfunction()

# A static library made of all .cpp files of the calling folder.
function(espalier_library target)
  cmake_parse_arguments(ARG "" "" "LINKS" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  add_library(${target} STATIC ${sources})
  espalier_defaults(${target})
  target_link_libraries(${target} PUBLIC glm::glm ${ARG_LINKS})
endfunction()

# A program made of all .cpp files of the calling folder.
function(espalier_program target)
  cmake_parse_arguments(ARG "" "" "LINKS" ${ARGN})
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  add_executable(${target} ${sources})
  espalier_defaults(${target})
  target_link_libraries(${target} PRIVATE ${ARG_LINKS})
endfunction()

# preload/NAME.c of the calling folder becomes a module that tests load into a program that they watch.
function(espalier_preload_here name)
  add_library(${name} MODULE preload/${name}.c)
  espalier_defaults(${name})
  target_link_libraries(${name} PRIVATE ${CMAKE_DL_LIBS})
  set_target_properties(${name} PROPERTIES LIBRARY_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests C_VISIBILITY_PRESET default)
endfunction()

# The .cpp files of the calling folder below tests/ become the doctest program test_FOLDER, run from the
# project's root. The environment variable ESPALIER_DATA may name a folder of further models (see tests/support).
function(espalier_test_here)
  cmake_parse_arguments(ARG "" "" "LINKS" ${ARGN})
  get_filename_component(folder ${CMAKE_CURRENT_SOURCE_DIR} NAME)
  file(GLOB sources CONFIGURE_DEPENDS ${CMAKE_CURRENT_SOURCE_DIR}/*.cpp)
  espalier_apart(${PROJECT_SOURCE_DIR}/tests/support/main.cpp)
  add_executable(test_${folder} ${sources} ${PROJECT_SOURCE_DIR}/tests/support/main.cpp)
  espalier_defaults(test_${folder})
  # Optimising the checks themselves takes longer than they do.
  target_compile_options(test_${folder} PRIVATE $<$<CONFIG:Release>:-O1>)
  target_link_libraries(test_${folder} PRIVATE doctest::doctest ${ARG_LINKS})
  set_target_properties(test_${folder} PROPERTIES RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}/tests)
  add_test(NAME ${folder} COMMAND test_${folder} WORKING_DIRECTORY ${PROJECT_SOURCE_DIR})
endfunction()
