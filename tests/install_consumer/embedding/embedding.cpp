// Contains things that our own sources may not have. If our warnings were forced on it, it would not compile.

#include <adamas/volume_store.h>

int main(int count, char** arguments) {
  int unused;
  if (count > 1) {
    int count = 3;
    return (int)adamas::VolumeStore::open(arguments[1]).grid().samples() + count;
  }
  return 0;
}
