// Tests compressed, encoded and ASCII arrays of .vti files, which are written byte by byte here.

#include "tests/io/volume_files.h"
#include "tests/io/vtk_xml_text.h"

namespace adamas {

using namespace io;

namespace {

using test::base64;
using test::bytes_of_values;
using test::message_of_volume;
using test::put_bytes;
using test::read_numbers;
using test::says;

struct Form {
  bool big = false, wide = false, compressed = false, encoded = false, appended = false;
};

std::string counts(const std::vector<std::uint64_t>& values, const Form& form) {
  if (form.wide) return bytes_of_values(values, form.big);
  return bytes_of_values(std::vector<std::uint32_t>(values.begin(), values.end()), form.big);
}

/// Returns the bytes of the array: one count and the samples, or compressed blocks of ten bytes.
std::string array_of(const std::string& bytes, const Form& form) {
  const auto code = [&](const std::string& text) { return form.encoded ? base64(text) : text; };
  if (!form.compressed) return code(counts({bytes.size()}, form) + bytes);
  std::vector<std::uint64_t> head{(bytes.size() + 9) / 10, 10, bytes.size() % 10};
  std::string blocks;
  for (std::size_t at = 0; at < bytes.size(); at += 10) {
    const std::string block = test::deflated(bytes.substr(at, 10), test::Wrapping::kZlib);
    head.push_back(block.size());
    blocks += block;
  }
  return code(counts(head, form)) + code(blocks);
}

std::string vti_of(const std::string& type, const std::string& array, const Form& form,
                   const std::string& format) {
  const std::string other =
      "<DataArray type=\"Int8\" Name=\"other\" format=\"ascii\">1 2 3 4 5 6 7 8 9 10 11 12</DataArray>\n";
  const std::string key = "<InformationKey name=\"a\" location=\"b\">7</InformationKey>\n";
  std::string text = fmt::format(
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"ImageData\" byte_order=\"{}\" header_type=\"{}\"{}>\n"
      "<ImageData WholeExtent=\"0 2 0 1 0 1\" Origin=\"1 2 3\" Spacing=\"1 1 1\" Direction=\"-1 0 0 0 1 0 0 "
      "0 1\">"
      "<!-- \" > --><Piece Extent=\"0 2 0 1 0 1\">\n<PointData Scalars=\"v\">{}"
      "<DataArray type=\"{}\" Name=\"v\" format=\"{}\"",
      form.big ? "BigEndian" : "LittleEndian", form.wide ? "UInt64" : "UInt32",
      form.compressed ? " compressor=\"vtkZLibDataCompressor\"" : "", form.appended ? "" : other, type,
      format);
  text +=
      form.appended ? " offset=\"5\"/>" : ">\n" + key + "          " + array + "\n" + key + "</DataArray>";
  text += "</PointData></Piece></ImageData>";
  if (form.appended) {
    text += fmt::format("<AppendedData encoding=\"{}\">\n _12345", form.encoded ? "base64" : "raw") + array +
            "</AppendedData>";
  }
  return text + "</VTKFile>\n";
}

std::vector<Form> forms() {
  std::vector<Form> all;
  for (unsigned bits = 0; bits < 32; ++bits) {
    const auto bit = [bits](unsigned i) { return (bits >> i & 1) != 0; };
    const Form form{bit(0), bit(1), bit(2), bit(3), bit(4)};
    if (form.encoded || form.appended) all.push_back(form);
  }
  return all;
}

TEST(PackedVti, EveryTypeInEveryForm) {
  const test::Scratch scratch;
  for (const StoredType type : test::kStoredTypes) {
    visit_stored_type(type, [&]<class T>(T) {
      const auto values = test::typical_values<T>();
      const char* name = stored_name(type, TypeNames::kVtk);
      for (const Form& form : forms()) {
        put_bytes(scratch / "a.vti", vti_of(name, array_of(bytes_of_values(values, form.big), form), form,
                                            form.appended ? "appended" : "binary"));
        VolumeReader reader = open_volume(scratch / "a.vti");
        EXPECT_EQ(read_numbers(reader), test::as_doubles(values))
            << name << form.big << form.wide << form.compressed << form.encoded << form.appended;
        EXPECT_EQ(reader.grid().box().min, (Vec3{-1, 2, 3}));
      }
      std::string text;
      for (const T v : values) text += fmt::format("{}\n ", +v);
      text.resize(text.find_last_not_of("\n ") + 1);
      for (const bool big : {false, true}) {
        put_bytes(scratch / "a.vti", vti_of(name, text, {.big = big}, "ascii"));
        VolumeReader reader = open_volume(scratch / "a.vti");
        EXPECT_EQ(read_numbers(reader), test::as_doubles(values)) << name << text;
      }
    });
  }
}

TEST(PackedVti, EveryTruncationIsAnError) {
  const test::Scratch scratch;
  const std::string bytes = bytes_of_values(test::typical_values<std::uint16_t>());
  for (const Form& form : forms()) {
    if (form.big || form.wide) continue;
    const std::string whole =
        vti_of("UInt16", array_of(bytes, form), form, form.appended ? "appended" : "binary");
    put_bytes(scratch / "a.vti", whole);
    // Nothing behind the array is needed.
    const std::size_t end = whole.find(form.appended ? "</AppendedData>" : "</PointData>");
    const std::size_t begin = whole.find(form.appended ? "<AppendedData" : "Name=\"v\"");
    test::expect_every_truncation_is_an_error(scratch / "a.vti", scratch / "a.vti", begin, 17);
    test::expect_every_truncation_is_an_error(scratch / "a.vti", scratch / "a.vti", end, 1, begin);
  }
  const std::string text = vti_of("UInt8", "1 2 3 4 5 6 7 8 9 10 11 12", {}, "ascii");
  put_bytes(scratch / "a.vti", text);
  test::expect_every_truncation_is_an_error(scratch / "a.vti", scratch / "a.vti", text.find("</PointData>"));
}

TEST(PackedVti, BadBlocks) {
  const test::Scratch scratch;
  const auto message = [&](const std::string& array, bool compressed = true) {
    const Form form{false, true, compressed, false, true};
    put_bytes(scratch / "a.vti", vti_of("UInt8", array, form, "appended"));
    return message_of_volume(scratch / "a.vti");
  };
  const Form wide{.wide = true};
  const std::uint64_t many = std::uint64_t{1} << 60;
  for (const auto& head : std::vector<std::vector<std::uint64_t>>{{0, 10, 2},
                                                                  {2, 10, 3},
                                                                  {2, 6, 7},
                                                                  {many, 12, 0},
                                                                  {many, many, many},
                                                                  {~0ull, ~0ull, 12},
                                                                  {0, 0, 0},
                                                                  {2, 0, 12}}) {
    EXPECT_TRUE(says(message(counts(head, wide)), "a.vti: expected compressed blocks for 12 bytes, found"));
  }
  EXPECT_TRUE(says(message(counts({12, 1, 0, 5}, wide)), "expected a count of 8 bytes before the samples"));
  const std::string block = test::deflated("abcdefghijkl", test::Wrapping::kZlib);
  EXPECT_TRUE(says(message(counts({1, 12, 0, block.size()}, wide) + "y" + block.substr(1)),
                   "a.vti: block 0: expected whole compressed data"));
  EXPECT_TRUE(says(message(counts({1, 12, 0, block.size() - 1}, wide) + block), "block 0: expected whole"));
  EXPECT_TRUE(says(message(counts({2, 11, 1, block.size(), 3}, wide) + block),
                   "block 0: expected 11 bytes, found more"));
  const std::string small = test::deflated("abc", test::Wrapping::kZlib);
  EXPECT_TRUE(
      says(message(counts({1, 12, 0, small.size()}, wide) + small), "block 0: expected 12 bytes, found 3"));
  EXPECT_TRUE(says(message(counts({11}, wide) + "abcdefghijkl", false),
                   "expected an array of 12 bytes, found one of 11"));
  put_bytes(scratch / "a.vti", vti_of("UInt8", "1 2 3 4 5 6 7 8 9 10 11 256", {}, "ascii"));
  EXPECT_TRUE(
      says(message_of_volume(scratch / "a.vti"), "expected 12 numbers of uint8, found '256' after 11"));
  put_bytes(scratch / "a.vti", vti_of("UInt8", "AAA", {}, "binary"));
  EXPECT_TRUE(
      says(message_of_volume(scratch / "a.vti"), "expected whole groups of four base64 characters, found 3"));
  put_bytes(scratch / "a.vti", vti_of("UInt8", "AA=A", {}, "binary"));
  EXPECT_TRUE(
      says(message_of_volume(scratch / "a.vti"), "expected base64 text, found a character of code 65"));
}

TEST(PackedVti, LongFilesOfManyArrays) {
  const test::Scratch scratch;
  const std::string bytes(3'000'000, 'z');
  const Form form{.encoded = true};
  std::string text =
      "<VTKFile type=\"ImageData\" byte_order=\"LittleEndian\"><ImageData WholeExtent=\"0 2999999 0 0 0 0\">"
      "<Piece Extent=\"0 2999999 0 0 0 0\"><PointData>";
  for (const char* name : {"a", "b", "c"}) {
    text += fmt::format("<DataArray type=\"UInt8\" Name=\"{}\" format=\"binary\">{}</DataArray>", name,
                        base64(counts({bytes.size()}, form) + std::string(3'000'000, name[0])));
  }
  put_bytes(scratch / "a.vti", text + "</PointData></Piece></ImageData></VTKFile>");
  for (const char* name : {"a", "b", "c"}) {
    VolumeReader reader = open_volume(scratch / "a.vti", {name, {}});
    EXPECT_EQ(test::read_as<char>(reader), std::vector<char>(3'000'000, name[0]));
  }
  EXPECT_TRUE(says(message_of_volume(scratch / "a.vti"), "expected one array on points or the name of one"));
}

}  // namespace
}  // namespace adamas
