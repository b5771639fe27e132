#pragma once

#include <memory>
#include <string>

namespace adamas {

/// While it lives, VTK's errors and warnings of the whole process are kept here instead of printed, and it
/// starts no threads.
class VtkMessages {
 public:
  VtkMessages();
  ~VtkMessages();
  VtkMessages(const VtkMessages&) = delete;
  VtkMessages& operator=(const VtkMessages&) = delete;

  /// Throws Error, as one line that begins with `name`, if there has been any message.
  void check(const std::string& name) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace adamas
