#include "core/io/vtk_messages.h"

#include <SMP/Common/vtkSMPToolsAPI.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <cctype>

#include "core/base/error.h"

namespace adamas {

namespace {

class QuietWindow : public vtkOutputWindow {
 public:
  static QuietWindow* New();
  vtkTypeMacro(QuietWindow, vtkOutputWindow) void DisplayText(const char* text) override { keep(text); }
  void DisplayErrorText(const char* text) override { keep(text); }
  void DisplayWarningText(const char* text) override { keep(text); }
  void DisplayGenericWarningText(const char* text) override { keep(text); }
  void DisplayDebugText(const char*) override {}

  std::string first;

 private:
  void keep(const char* text) {
    if (first.empty() && text != nullptr) first = text;
  }
};
vtkStandardNewMacro(QuietWindow);

/// "ERROR: In file.cxx, line 1\nvtkClass (0x0): What happened" becomes "What happened", in one line.
std::string one_line(const std::string& text) {
  std::size_t begin = 0;
  if (text.rfind("ERROR", 0) == 0 || text.rfind("Warning", 0) == 0 || text.rfind("Generic Warning", 0) == 0) {
    begin = std::min(text.find('\n'), text.size() - 1) + 1;
  }
  const std::size_t object = text.find("): ", begin);
  if (text.compare(begin, 3, "vtk") == 0 && object != std::string::npos) begin = object + 3;
  std::string line;
  for (std::size_t i = begin; i < text.size() && line.size() < 300; ++i) {
    const auto c = static_cast<unsigned char>(text[i]);
    if (std::isspace(c) != 0 || std::iscntrl(c) != 0) {
      if (!line.empty() && line.back() != ' ') line += ' ';
    } else {
      line += text[i];
    }
  }
  while (!line.empty() && (line.back() == ' ' || line.back() == '.')) line.pop_back();
  return line;
}

}  // namespace

struct VtkMessages::State {
  vtkSmartPointer<vtkOutputWindow> previous;
  vtkSmartPointer<QuietWindow> window;
};

VtkMessages::VtkMessages() : state_(std::make_unique<State>()) {
  vtk::detail::smp::vtkSMPToolsAPI::GetInstance().SetBackend("Sequential");
  state_->previous = vtkOutputWindow::GetInstance();
  state_->window = vtkSmartPointer<QuietWindow>::New();
  vtkOutputWindow::SetInstance(state_->window);
}

VtkMessages::~VtkMessages() { vtkOutputWindow::SetInstance(state_->previous); }

void VtkMessages::check(const std::string& name) const {
  if (!state_->window->first.empty()) fail("{}: {}", name, one_line(state_->window->first));
}

}  // namespace adamas
