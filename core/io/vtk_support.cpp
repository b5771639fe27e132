#include "core/io/vtk_support.h"

#include <SMP/Common/vtkSMPToolsAPI.h>
#include <vtkDataArray.h>
#include <vtkDataSetReader.h>
#include <vtkDoubleArray.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkObjectFactory.h>
#include <vtkOutputWindow.h>
#include <vtkSmartPointer.h>
#include <vtkStringArray.h>
#include <vtkUnsignedCharArray.h>
#include <vtkXMLWriter.h>

#include <algorithm>
#include <cctype>
#include <cmath>

#include "core/base/error.h"
#include "core/io/output_stream.h"
#include "core/io/xml_file.h"

namespace adamas::io {

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

/// Shortens "ERROR: In file.cxx, line 1\nvtkClass (0x0): What happened" to "What happened", in one line.
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

template <class Array, class T>
vtkSmartPointer<vtkAbstractArray> numbers(const std::vector<T>& values, int components) {
  const auto array = vtkSmartPointer<Array>::New();
  array->SetNumberOfComponents(components);
  array->SetNumberOfTuples(static_cast<vtkIdType>(values.size() / static_cast<std::size_t>(components)));
  std::copy(values.begin(), values.end(), array->GetPointer(0));
  return array;
}

vtkSmartPointer<vtkAbstractArray> strings(const std::vector<std::string>& values, int components) {
  const auto array = vtkSmartPointer<vtkStringArray>::New();
  array->SetNumberOfComponents(components);
  array->SetNumberOfValues(static_cast<vtkIdType>(values.size()));
  for (std::size_t i = 0; i < values.size(); ++i) array->SetValue(static_cast<vtkIdType>(i), values[i]);
  return array;
}

template <class T>
std::vector<T> copied(vtkDataArray& array) {
  const auto* data = static_cast<const T*>(array.GetVoidPointer(0));
  return {data, data + array.GetNumberOfValues()};
}

/// Converts values of another type: to int32 if they are whole and fit, else to double.
NamedArray converted(vtkDataArray& source, NamedArray array) {
  std::vector<double> values;
  bool whole = source.GetDataType() != VTK_FLOAT && source.GetDataType() != VTK_DOUBLE;
  for (vtkIdType i = 0; i < source.GetNumberOfTuples(); ++i) {
    for (int c = 0; c < array.components; ++c) values.push_back(source.GetComponent(i, c));
  }
  whole = whole &&
          std::all_of(values.begin(), values.end(), [](double v) { return std::abs(v) <= 2147483647.0; });
  if (whole) {
    array.values = std::vector<std::int32_t>(values.begin(), values.end());
  } else {
    array.values = std::move(values);
  }
  return array;
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

vtkSmartPointer<vtkAbstractArray> to_vtk(const NamedArray& array) {
  vtkSmartPointer<vtkAbstractArray> result;
  switch (array.values.index()) {
    case 0:
      result = numbers<vtkDoubleArray>(std::get<0>(array.values), array.components);
      break;
    case 1:
      result = numbers<vtkFloatArray>(std::get<1>(array.values), array.components);
      break;
    case 2:
      result = numbers<vtkIntArray>(std::get<2>(array.values), array.components);
      break;
    case 3:
      result = numbers<vtkUnsignedCharArray>(std::get<3>(array.values), array.components);
      break;
    default:
      result = strings(std::get<4>(array.values), array.components);
  }
  result->SetName(xml_attribute(array.name).c_str());
  return result;
}

NamedArray from_vtk(vtkAbstractArray& source) {
  NamedArray array;
  array.name = source.GetName() != nullptr ? source.GetName() : "";
  array.components = source.GetNumberOfComponents();
  if (auto* texts = vtkStringArray::SafeDownCast(&source)) {
    std::vector<std::string> values;
    for (vtkIdType i = 0; i < texts->GetNumberOfValues(); ++i) values.push_back(texts->GetValue(i));
    array.values = std::move(values);
    return array;
  }
  auto* data = vtkDataArray::SafeDownCast(&source);
  if (data == nullptr)
    fail("array '{}': expected numbers or strings, found {}", array.name, source.GetClassName());
  if (!data->HasStandardMemoryLayout()) return converted(*data, std::move(array));
  switch (data->GetDataType()) {
    case VTK_DOUBLE:
      array.values = copied<double>(*data);
      return array;
    case VTK_FLOAT:
      array.values = copied<float>(*data);
      return array;
    case VTK_INT:
      array.values = copied<std::int32_t>(*data);
      return array;
    case VTK_UNSIGNED_CHAR:
      array.values = copied<std::uint8_t>(*data);
      return array;
    default:
      return converted(*data, std::move(array));
  }
}

vtkSmartPointer<vtkDataObject> read_legacy_vtk(const std::string& name, const VtkMessages& messages) {
  const auto reader = vtkSmartPointer<vtkDataSetReader>::New();
  reader->ReadAllScalarsOn();
  reader->ReadAllVectorsOn();
  reader->ReadAllNormalsOn();
  reader->ReadAllTensorsOn();
  reader->ReadAllColorScalarsOn();
  reader->ReadAllTCoordsOn();
  reader->ReadAllFieldsOn();
  return read_with_vtk(*reader, name, messages);
}

void write_with_vtk(const std::filesystem::path& path, vtkXMLWriter& writer) {
  const VtkMessages messages;
  writer.SetDataModeToAppended();
  writer.EncodeAppendedDataOff();
  writer.SetCompressorTypeToZLib();
  writer.SetHeaderTypeToUInt64();
  // VTK does not report every short write, so this program writes the bytes to the file itself.
  writer.WriteToOutputStringOn();
  OutputStream out(path);
  const int written = writer.Write();
  messages.check(path.string());
  if (written == 0) fail("{}: could not be written", path.string());
  const std::string bytes = writer.GetOutputString();
  out.write(bytes);
  out.finish();
}

}  // namespace adamas::io
