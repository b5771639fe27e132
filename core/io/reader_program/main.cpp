// adamas-reader: runs readers of libraries that may crash on corrupt files, for read_in_child.

#include <unistd.h>

#include "core/io/reader_program.h"

/// Ends without the destructors of libraries, which may fail on what they hold of a corrupt file.
int main() { ::_exit(adamas::io::run_reader_program()); }
