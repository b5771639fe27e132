#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <mutex>
#include <thread>

namespace adamas::viewer {

/// A thread that does one thing at a time, while others go on.
class WorkThread {
 public:
  WorkThread();
  /// Waits for what is being done.
  ~WorkThread();
  WorkThread(const WorkThread&) = delete;
  WorkThread& operator=(const WorkThread&) = delete;

  /// Begins work, after what is being done.
  void begin(std::function<void()> work);
  /// Whether all that was begun is done. Throws what it has thrown, once.
  [[nodiscard]] bool is_idle();

 private:
  void run();

  std::mutex mutex_;
  std::condition_variable changed_;
  std::function<void()> work_;  ///< empty: nothing to do
  std::exception_ptr thrown_;
  bool is_ended_ = false;
  std::thread thread_;
};

}  // namespace adamas::viewer
