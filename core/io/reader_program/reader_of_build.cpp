// Makes the program that links this file use the adamas-reader of this build, unless its user has named one.

#include <cstdlib>

namespace {

[[maybe_unused]] const int kNamed = ::setenv("ADAMAS_READER_PROGRAM", ADAMAS_READER_PROGRAM, 0);

}  // namespace
