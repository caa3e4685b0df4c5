# What every target of Clothlab is compiled with.
function(clothlab_target target)
  target_compile_features(${target} PUBLIC cxx_std_20)
  target_compile_options(${target} PRIVATE -Wall -Wextra -Wpedantic -Wshadow)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
    # False alarms on "text" + string, GCC bugs 105651 and 105329, and of its kind.
    target_compile_options(${target} PRIVATE -Wno-restrict -Wno-stringop-overflow -Wno-array-bounds -Wno-stringop-overread)
  endif()
  if(CLOTHLAB_WARNINGS_AS_ERRORS)
    target_compile_options(${target} PRIVATE -Werror)
  endif()
  if(CLOTHLAB_FUZZ)
    target_compile_options(${target} PRIVATE -fsanitize=fuzzer-no-link)  # counts what an input reaches
  endif()
  if(CLOTHLAB_SANITIZE)
    target_compile_options(${target} PRIVATE -fsanitize=${CLOTHLAB_SANITIZE} -fno-omit-frame-pointer)
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
      target_compile_options(${target} PRIVATE -Wno-maybe-uninitialized)  # false alarms on std::regex, GCC bug 105562
    endif()
    target_link_options(${target} PRIVATE -fsanitize=${CLOTHLAB_SANITIZE})
  endif()
endfunction()

# Headers that most files of a target read, parsed once: half of a build's time. A file that is compiled for another
# processor than the rest stays without (SKIP_PRECOMPILE_HEADERS): what it includes is its own affair.
set(clothlab_common_headers <algorithm> <array> <chrono> <cmath> <filesystem> <functional> <limits> <map> <memory>
  <optional> <set> <span> <string> <utility> <variant> <vector> <Eigen/Core> <Eigen/Geometry> <fmt/format.h>)

# For a target of one room, which reads its headers but once where rooms are united.
function(clothlab_precompile_unless_united target)
  if(NOT CMAKE_UNITY_BUILD)
    target_precompile_headers(${target} PRIVATE ${clothlab_common_headers} ${ARGN})
  endif()
endfunction()

# Where CMAKE_UNITY_BUILD is on, the files of a folder are compiled as one, so that a new file changes its own room alone.
# To be called when the target has all its sources.
function(clothlab_unite_rooms target)
  set_target_properties(${target} PROPERTIES UNITY_BUILD_MODE GROUP)
  get_target_property(sources ${target} SOURCES)
  foreach(source ${sources})
    get_filename_component(room ${source} DIRECTORY)
    string(MAKE_C_IDENTIFIER "room_${room}" room)
    set_source_files_properties(${source} TARGET_DIRECTORY ${target} PROPERTIES UNITY_GROUP ${room})
  endforeach()
endfunction()
