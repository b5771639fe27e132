#pragma once

#include <string>
#include <string_view>
#include <utility>

#include "adamas/progress.h"

namespace adamas::workflow {

/// Passes on progress and notes about several things that are done one after another. The name of the present
/// one is put before notes that do not begin with it.
class NamedProgress : public Progress {
 public:
  explicit NamedProgress(Progress& all) : all_(all) {}

  /// Sets the name of the present thing; empty: notes stay as they are.
  void set_name(std::string name) { name_ = std::move(name); }

  void report(std::string_view stage, double fraction) override { all_.report(stage, fraction); }
  void note(NoteKind kind, std::string_view text) override {
    const std::string beginning = name_.empty() ? "" : name_ + ": ";
    all_.note(kind, text.starts_with(beginning) ? std::string(text) : beginning + std::string(text));
  }
  [[nodiscard]] bool wants_all_notes() const override { return all_.wants_all_notes(); }
  [[nodiscard]] bool cancelled() const override { return all_.cancelled(); }

 private:
  Progress& all_;
  std::string name_;
};

}  // namespace adamas::workflow
