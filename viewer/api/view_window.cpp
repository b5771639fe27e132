#include "adamas/view.h"
#include "viewer/api/view_options.h"
#include "viewer/session/remembered_states.h"
#include "viewer/window/window.h"

namespace adamas {

using namespace viewer;

namespace {

constexpr ViewPlace kPlace = ViewPlace::kWindow;

std::vector<std::string> names_of(const std::vector<std::filesystem::path>& files) {
  std::vector<std::string> names;
  for (const std::filesystem::path& file : files) names.push_back(file.string());
  return names;
}

WindowOptions window_options(const ViewOptions& options) {
  WindowOptions window;
  const auto [width, height] = picture_size(options, {window.width, window.height});
  window.width = width;
  window.height = height;
  window.documents = document_options(options, kPlace);
  window.documents.colour_by.clear();
  return window;
}

}  // namespace

struct ViewWindow::Contents {
  explicit Contents(const ViewOptions& options)
      : window(window_options(options)), view(window.width, window.height) {}

  WindowOptions window;
  ViewSession view;
};

ViewWindow::ViewWindow(const ViewOptions& options, Progress& progress) {
  check_view_options(options);
  contents_ = std::make_unique<Contents>(options);
  ViewSession& view = contents_->view;
  for (const std::filesystem::path& file : options.files)
    view.open(file.string(), document_options(options, kPlace), progress);
  restore_state(options, view);
  if (options.state.empty() && !options.fresh) {
    if (const auto remembered = remembered_state(remembered_states_file(), names_of(options.files)))
      view.restore(*remembered);
  }
  apply_view_options(options, kPlace, view);
}

ViewWindow::ViewWindow(ViewWindow&&) noexcept = default;
ViewWindow& ViewWindow::operator=(ViewWindow&&) noexcept = default;
ViewWindow::~ViewWindow() = default;

void ViewWindow::show(Progress& progress) {
  auto& [window, view] = *contents_;
  window.is_ended = [&progress] { return progress.cancelled(); };
  show_window(view, window);
  std::vector<std::string> names;
  for (const auto& document : view.documents()) names.push_back(document->facts().name);
  const std::filesystem::path memory = remembered_states_file();
  if (!memory.empty()) remember_state(memory, names, view.remembered());
  progress.check();
}

}  // namespace adamas
