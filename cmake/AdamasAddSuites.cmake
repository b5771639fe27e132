# ctest includes this: each suite of the GoogleTest program `program` becomes a test of its name. A process for each test would
# cost minutes, and the tests of a suite share what they make once. Suites named Long* have the label "long"; those of many
# tests begin first, so that none is left alone at the end.
execute_process(COMMAND ${program} --gtest_list_tests OUTPUT_VARIABLE listed RESULT_VARIABLE failure TIMEOUT 60)
if(failure)
  add_test("${program}_NOT_BUILT" "${program}_NOT_BUILT")
  return()
endif()
# Suites stand at the beginning of a line, tests behind two spaces; parameters stand in comments.
string(REGEX REPLACE "#[^\n]*" "" listed "${listed}")
string(REGEX MATCHALL "\n?[^ \n]+\\. *(\n  [^\n]+)+" suites "${listed}")
foreach(suite IN LISTS suites)
  string(REGEX MATCHALL "\n  " tests "${suite}")
  list(LENGTH tests count)
  string(REGEX MATCH "[^ \n]+\\." suite "${suite}")
  string(REGEX REPLACE "\\.$" "" name "${suite}")
  add_test("${name}" ${program} "--gtest_filter=${name}.*")
  set_tests_properties("${name}" PROPERTIES TIMEOUT 1200 COST ${count})
  if(name MATCHES "(^|/)Long")
    set_tests_properties("${name}" PROPERTIES TIMEOUT 2400 LABELS long)
  endif()
endforeach()
