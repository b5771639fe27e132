// Names the adamas-reader of this build to the program that this is linked to, unless its user has named one.

#include <cstdlib>

namespace {

[[maybe_unused]] const int kNamed = ::setenv("ADAMAS_READER_PROGRAM", ADAMAS_READER_PROGRAM, 0);

}  // namespace
