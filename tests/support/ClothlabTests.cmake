# A GoogleTest program whose tests ctest lists one by one.
#
#     clothlab_test(NAME LABEL word TIMEOUT seconds SOURCES ... [LIBRARIES ...])
include(GoogleTest)
function(clothlab_test name)
  cmake_parse_arguments(TEST "" "LABEL;TIMEOUT" "SOURCES;LIBRARIES" ${ARGN})
  add_executable(${name} ${TEST_SOURCES})
  target_link_libraries(${name} PRIVATE clothlab_test_support GTest::gtest_main ${TEST_LIBRARIES})
  target_precompile_headers(${name} REUSE_FROM clothlab_test_support)
  clothlab_target(${name})
  gtest_discover_tests(${name} DISCOVERY_TIMEOUT 60 PROPERTIES LABELS ${TEST_LABEL} TIMEOUT ${TEST_TIMEOUT})
endfunction()
