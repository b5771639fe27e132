#include "core/base/unnamed_file.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <string>

namespace adamas {

int open_unnamed_file(const std::filesystem::path& folder) {
  const int unnamed = ::open(folder.c_str(), O_TMPFILE | O_RDWR | O_CLOEXEC, 0600);
  if (unnamed >= 0) return unnamed;
  // Some file systems cannot make files without names. No signal ends this thread while there is one.
  sigset_t all{}, before{};
  sigfillset(&all);
  ::pthread_sigmask(SIG_BLOCK, &all, &before);
  std::string pattern = (folder / "adamas-scratch-XXXXXX").string();
  const int named = ::mkostemp(pattern.data(), O_CLOEXEC);
  const int reason = errno;
  if (named >= 0) ::unlink(pattern.c_str());
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  errno = reason;
  return named;
}

}  // namespace adamas
