#include "adamas/version.h"

#define ADAMAS_TEXT_OF(x) #x
#define ADAMAS_TEXT(x) ADAMAS_TEXT_OF(x)

namespace adamas {

const char* version() {
  return ADAMAS_TEXT(ADAMAS_VERSION_MAJOR) "." ADAMAS_TEXT(ADAMAS_VERSION_MINOR) "." ADAMAS_TEXT(
      ADAMAS_VERSION_PATCH);
}

}  // namespace adamas
