// Tests arrays of NumPy, which are written byte by byte here, and by NumPy itself.

#include <cstdlib>
#include <numeric>
#include <utility>

#include "core/io/grid_file.h"
#include "core/io/input_formats.h"
#include "core/io/numpy_header.h"
#include "tests/io/volume_files.h"

namespace adamas {

using namespace io;

namespace {

using test::bytes_of_values;
using test::deflated;
using test::error_of;
using test::message_of_volume;
using test::put_bytes;
using test::read_numbers;
using test::says;
using test::Wrapping;

VolumeOptions named(const std::string& array) {
  VolumeOptions options;
  options.array = array;
  return options;
}

template <class T>
std::string le(T value) {
  return bytes_of_values(std::vector<T>{value});
}

/// Returns a file of a version of the format with this header and these bytes behind it.
std::string npy(const std::string& dictionary, const std::string& values, int version = 1) {
  const std::string text = dictionary + " \n";
  const std::string length = version == 1 ? le(static_cast<std::uint16_t>(text.size()))
                                          : le(static_cast<std::uint32_t>(text.size()));
  return "\x93NUMPY" + std::string{static_cast<char>(version), '\0'} + length + text + values;
}

std::string dictionary_of(const std::string& descr, const std::string& shape, bool fortran = false) {
  return "{'descr': " + descr + ", 'fortran_order': " + (fortran ? "True" : "False") + ", 'shape': " + shape +
         ", }";
}
std::string dictionary(const std::string& type, const std::string& shape, bool fortran = false) {
  return dictionary_of("'" + type + "'", shape, fortran);
}

/// Returns a zip archive of these files. `large`: with numbers of 64 bits where an archive may have them.
std::string zip(const std::vector<std::pair<std::string, std::string>>& files, bool deflate,
                bool large = false, const std::string& comment = {}) {
  std::string archive, directory;
  for (const auto& [name, content] : files) {
    const std::string bytes = deflate ? deflated(content, Wrapping::kNone) : content;
    const std::string method = le(static_cast<std::uint16_t>(deflate ? 8 : 0));
    const std::uint32_t elsewhere = 0xffffffff;
    const auto place = archive.size();
    std::string extra, local_extra = "\x55\x54" + le(std::uint16_t{3}) + "abc";
    if (large) {
      extra = le(std::uint16_t{7}) + le(std::uint16_t{2}) + "xy" + le(std::uint16_t{1}) +
              le(std::uint16_t{24}) + le(std::uint64_t{content.size()}) + le(std::uint64_t{bytes.size()}) +
              le(std::uint64_t{place});
    }
    const auto sizes =
        large ? le(elsewhere) + le(elsewhere)
              : le(static_cast<std::uint32_t>(bytes.size())) + le(static_cast<std::uint32_t>(content.size()));
    const auto checksum = static_cast<std::uint32_t>(
        crc32(0, reinterpret_cast<const Bytef*>(content.data()), static_cast<uInt>(content.size())));
    const std::string middle = le(std::uint16_t{45}) + le(std::uint16_t{0}) + method + std::string(4, '\0') +
                               le(checksum) + sizes + le(static_cast<std::uint16_t>(name.size()));
    archive +=
        "PK\3\4" + middle + le(static_cast<std::uint16_t>(local_extra.size())) + name + local_extra + bytes;
    directory += "PK\1\2" + le(std::uint16_t{45}) + middle + le(static_cast<std::uint16_t>(extra.size())) +
                 std::string(10, '\0') + le(large ? elsewhere : static_cast<std::uint32_t>(place)) + name +
                 extra;
  }
  const auto begin = archive.size();
  archive += directory;
  const auto count = static_cast<std::uint16_t>(files.size());
  if (large) {
    const auto end = archive.size();
    archive += "PK\6\6" + le(std::uint64_t{44}) + std::string(12, '\0') + le(std::uint64_t{count}) +
               le(std::uint64_t{count}) + le(std::uint64_t{directory.size()}) + le(std::uint64_t{begin});
    archive += "PK\6\7" + le(std::uint32_t{0}) + le(std::uint64_t{end}) + le(std::uint32_t{1});
  }
  archive += "PK\5\6" + le(std::uint32_t{0}) + le(count) + le(count) +
             le(large ? 0xffffffff : static_cast<std::uint32_t>(directory.size())) +
             le(large ? 0xffffffff : static_cast<std::uint32_t>(begin)) +
             le(static_cast<std::uint16_t>(comment.size())) + comment;
  return archive;
}

std::vector<double> numbers_of(const GridArray& array) {
  return std::visit([](const auto& values) { return std::vector<double>(values.begin(), values.end()); },
                    array.values);
}

TEST(NumpyArray, EveryTypeInEitherByteOrder) {
  const test::Scratch scratch;
  constexpr const char* kNames[] = {"i1", "u1", "i2", "u2", "i4", "u4", "i8", "u8", "f4", "f8"};
  for (const StoredType type : test::kStoredTypes) {
    visit_stored_type(type, [&]<class T>(T) {
      for (const bool big : {false, true}) {
        const auto values = test::typical_values<T>();
        const std::string name = kNames[static_cast<std::size_t>(type)];
        const std::string order = sizeof(T) == 1 ? "|" : big ? ">" : "<";
        const std::string bytes = bytes_of_values(values, big);
        const std::string c = npy(dictionary(order + name, "(2, 2, 3)"), bytes),
                          f = npy(dictionary(order + name, "(3, 2, 2)", true), bytes);
        put_bytes(scratch / "a.npy", c);
        put_bytes(scratch / "b.npy", f);
        put_bytes(scratch / "c.bin", c);
        put_bytes(scratch / "d.npz", zip({{"v.npy", c}}, false));
        put_bytes(scratch / "e.npz", zip({{"v.npy", f}}, true));
        put_bytes(scratch / "f.npz", zip({{"v.npy", c}}, true, true, "a comment"));
        put_bytes(scratch / "g.npz", zip({{"v.npy", c}}, false, true));
        for (const char* file : {"a.npy", "b.npy", "c.bin", "d.npz", "e.npz", "f.npz", "g.npz"}) {
          VolumeReader reader = open_volume(scratch / file);
          EXPECT_EQ(reader.grid().dimensions, (std::array<std::uint64_t, 3>{3, 2, 2})) << file;
          EXPECT_EQ(reader.grid().type, sample_type_for(type));
          EXPECT_EQ(read_numbers(reader), test::as_doubles(values)) << file << " " << name << big;
          EXPECT_EQ(numbers_of(read_grid_file(scratch / file).arrays.at(0)), test::as_doubles(values))
              << file << " " << name << big;
        }
      }
    });
  }
}

TEST(NumpyArray, HeadersOfAllVersions) {
  const auto parse = [](const std::string& text, int version = 1) {
    return parse_numpy_header(npy(text, "", version), "a.npy");
  };
  for (const int version : {1, 2, 3}) {
    const NumpyHeader header = parse(dictionary(">f8", "(4, 5, 6)"), version);
    EXPECT_EQ(header.shape, (std::vector<std::uint64_t>{4, 5, 6}));
    EXPECT_EQ(header.type, StoredType::kFloat64);
    EXPECT_TRUE(header.big_endian);
    EXPECT_FALSE(header.fortran_order);
    EXPECT_EQ(header.bytes, npy(dictionary(">f8", "(4, 5, 6)"), "", version).size());
  }
  EXPECT_EQ(parse(dictionary("<i8", "(3L, 4L)", true)).shape, (std::vector<std::uint64_t>{3, 4}));
  EXPECT_EQ(parse(dictionary("|b1", "(7,)")).type, StoredType::kUint8);
  EXPECT_TRUE(parse(dictionary("<u2", "()")).shape.empty());
  EXPECT_TRUE(parse("{\"shape\":(2,3),\"fortran_order\":True,\"descr\":\"<f4\"}").fortran_order);
}

TEST(NumpyArray, FourAxesHoldComponentsOrTimes) {
  const test::Scratch scratch;
  std::vector<std::uint8_t> values(2 * 3 * 4 * 5);
  std::iota(values.begin(), values.end(), std::uint8_t{0});
  const std::string bytes = bytes_of_values(values);
  struct Case {
    const char* shape;
    bool fortran, slowest;
    std::string axes;
  };
  for (const Case& c : {Case{"(2, 3, 4, 5)", false, true, "component, z, y, x"},
                        {"(3, 4, 5, 2)", false, false, "z, y, x, component"},
                        {"(2, 5, 4, 3)", true, false, "component, x, y, z (Fortran order)"},
                        {"(5, 4, 3, 2)", true, true, "x, y, z, component (Fortran order)"}}) {
    put_bytes(scratch / "a.npy", npy(dictionary("|u1", c.shape, c.fortran), bytes));
    put_bytes(scratch / "a.npz", zip({{"v.npy", npy(dictionary("|u1", c.shape, c.fortran), bytes)}}, true));
    for (const char* name : {"a.npy", "a.npz"}) {
      const GridFile file = read_grid_file(scratch / name);
      EXPECT_EQ(file.kind, "NumPy array of axes " + c.axes);
      EXPECT_EQ(file.nodes[0].size(), 5u);
      EXPECT_EQ(file.nodes[2].size(), 3u);
      ASSERT_EQ(file.arrays.at(0).components, 2);
      const std::vector<double> found = numbers_of(file.arrays.at(0));
      for (std::size_t i = 0; i < 60; ++i) {
        EXPECT_EQ(found[2 * i], c.slowest ? static_cast<double>(i) : static_cast<double>(2 * i)) << c.axes;
        EXPECT_EQ(found[2 * i + 1], c.slowest ? static_cast<double>(60 + i) : static_cast<double>(2 * i + 1));
      }
    }
  }
  put_bytes(scratch / "t.npy", npy(dictionary("|u1", "(2, 3, 4, 5)"), bytes));
  VolumeOptions later;
  later.time = 1;
  VolumeReader second = open_volume(scratch / "t.npy", later);
  EXPECT_EQ(read_numbers(second).front(), 60);
  EXPECT_EQ(find_volume_series(scratch / "t.npy", "").steps.size(), 2u);
  EXPECT_TRUE(says(message_of_volume(scratch / "t.npy"), "found 2 times"));
  // Axes of one value are no axes where there are more than three.
  put_bytes(scratch / "o.npy", npy(dictionary("|u1", "(1, 6, 4, 1, 5)"), bytes));
  EXPECT_EQ(open_volume(scratch / "o.npy").grid().dimensions, (std::array<std::uint64_t, 3>{5, 4, 6}));
}

TEST(NumpyArray, ArraysOfAnArchiveAreChosenByName) {
  const test::Scratch scratch;
  const auto array = [](const std::string& values) { return npy(dictionary("|u1", "(1, 2, 2)"), values); };
  put_bytes(
      scratch / "a.npz",
      zip({{"x.npy", npy(dictionary("|u1", "(2,)"), "zz")},
           {"first.npy", array("abcd")},
           {"second.npy", array("efgh")},
           {"notes.txt", "words"},
           {"names.npy", npy(dictionary("<U1", "(2,)"), "12345678")},
           {"rows.npy", npy(dictionary_of("[('a', '<f4'), (\"b\", '<i2', (3,))]", "(1,)"), "0123456789")},
           {"none.npy", npy(dictionary("<f4", "(0,)"), "")}},
          true));
  VolumeReader second = open_volume(scratch / "a.npz", named("second"));
  EXPECT_EQ(read_numbers(second), (std::vector<double>{'e', 'f', 'g', 'h'}));
  EXPECT_TRUE(says(message_of_volume(scratch / "a.npz"), "'first', 'second'"));
  const GridFile file = read_grid_file(scratch / "a.npz");
  ASSERT_EQ(file.arrays.size(), 2u);
  EXPECT_EQ(file.arrays[0].name, "first");
  EXPECT_EQ(numbers_of(file.arrays[1]), (std::vector<double>{'e', 'f', 'g', 'h'}));
  EXPECT_TRUE(
      says(file.remark, "'notes.txt', 'names.npy', 'rows.npy', 'none.npy', 'x.npy' of another shape or kind"))
      << file.remark;
}

TEST(NumpyArray, WhatIsNoArrayOfNumbers) {
  const auto message = [](const std::string& text, const std::string& values = "") {
    const test::Scratch scratch;
    put_bytes(scratch / "a.npy", npy(text, values));
    return message_of_volume(scratch / "a.npy");
  };
  EXPECT_TRUE(says(message(dictionary("|O", "(2, 2)")), "truth values, float32 or float64, found '|O'"));
  EXPECT_TRUE(says(message(dictionary("<f2", "(2, 2)")), "found '<f2'"));
  EXPECT_TRUE(says(message(dictionary("<c8", "(2, 2)")), "found '<c8'"));
  EXPECT_TRUE(says(message(dictionary_of("[('a', '<f4')]", "(2,)")), "found records"));
  EXPECT_TRUE(
      says(message(dictionary("|u1", "(0, 2)")), "one to four axes with values, found the shape (0, 2)"));
  EXPECT_TRUE(says(message(dictionary("|u1", "(2, 3, 4, 5, 6)")), "found the shape (2, 3, 4, 5, 6)"));
  EXPECT_TRUE(says(message(dictionary("<f4", "(2, 2)"), "123"), "expected 16 bytes"));
  EXPECT_TRUE(says(message(dictionary("<f8", "(4000000000, 4000000000, 4000000000)")), "expected"));
  for (const char* text :
       {"", "{", "{}", "{'descr': '<f4'}", "{'descr': '<f4', 'fortran_order': Maybe, 'shape': (1,)}",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (1 2)}",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (-1,)}",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (1,), 'shape': (2,)}",
        "{'descr': '<f4', 'fortran_order': False, 'shape': (99999999999999999999,)}"})
    EXPECT_TRUE(says(message(text), "expected a header of NumPy with descr, fortran_order and shape, found"))
        << text;
  const test::Scratch scratch;
  put_bytes(scratch / "a.npy", "\x93NUMPY\4\0\0\0");
  EXPECT_TRUE(says(message_of_volume(scratch / "a.npy"), "expected NumPy's format 1 to 3, found 4"));
  put_bytes(scratch / "a.npy", "something else");
  EXPECT_TRUE(says(message_of_volume(scratch / "a.npy"), "expected an array of NumPy, found something else"));
  put_bytes(scratch / "a.npz", zip({{"notes.txt", "words"}}, true));
  EXPECT_TRUE(says(message_of_volume(scratch / "a.npz"), "expected an array of numbers, found 'notes.txt'"));
  put_bytes(scratch / "a.npz", zip({{"v.npy", npy(dictionary("|u1", "(2, 2)"), "12345")}}, false));
  EXPECT_TRUE(says(message_of_volume(scratch / "a.npz"), "expected 4 bytes for 2 x 2 x 1 samples of uint8"));
}

TEST(NumpyArray, DamagedFilesAreRefusedInOneLine) {
  const test::Scratch scratch;
  const std::string array = npy(dictionary("<u2", "(2, 2, 3)"), std::string(24, 'a'));
  put_bytes(scratch / "a.npy", array);
  test::expect_every_truncation_is_an_error(scratch / "a.npy", scratch / "a.npy", array.size());
  for (const bool large : {false, true}) {
    const std::string archive = zip({{"v.npy", array}, {"w.npy", array}}, true, large);
    put_bytes(scratch / "b.npz", archive);
    test::expect_every_truncation_is_an_error(scratch / "b.npz", scratch / "b.npz", archive.size());
    // Wherever a bit is wrong, either one line tells of it or the numbers are right nevertheless.
    for (std::size_t at = 0; at < archive.size(); ++at) {
      std::string flipped = archive;
      flipped[at] = static_cast<char>(flipped[at] ^ (1 << at % 8));
      put_bytes(scratch / "b.npz", flipped);
      try {
        for (const GridArray& found : read_grid_file(scratch / "b.npz").arrays)
          EXPECT_EQ(numbers_of(found), std::vector<double>(12, 0x6161)) << at;
      } catch (const Error& e) {
        EXPECT_EQ(std::string(e.what()).find('\n'), std::string::npos) << at;
        EXPECT_TRUE(says(e.what(), "b.npz")) << e.what();
      }
    }
  }
}

TEST(NumpyArray, FilesOfNumpyItself) {
  const test::Scratch scratch;
  put_bytes(scratch / "write.py",
            "import numpy as np, sys\n"
            "a = (np.arange(2 * 3 * 4).reshape(2, 3, 4) * 7 - 20).astype('<i2')\n"
            "np.save('c.npy', a)\n"
            "np.save('f.npy', np.asfortranarray(a.T))\n"
            "np.save('b.npy', a.astype('>f8'))\n"
            "np.savez('s.npz', a=a, edges=np.arange(5.0))\n"
            "np.savez_compressed('z.npz', a=a)\n");
  const std::string command =
      "cd '" + scratch.folder().string() + "' && /usr/bin/python3 write.py 2> /dev/null";
  if (std::system(command.c_str()) != 0) GTEST_SKIP() << "NumPy is not installed";
  for (const char* file : {"c.npy", "f.npy", "b.npy", "s.npz", "z.npz"}) {
    VolumeReader reader = open_volume(scratch / file, named(file[2] == 'n' && file[4] == 'z' ? "a" : ""));
    EXPECT_EQ(reader.grid().dimensions, (std::array<std::uint64_t, 3>{4, 3, 2})) << file;
    const std::vector<double> found = read_numbers(reader);
    for (std::size_t i = 0; i < found.size(); ++i)
      EXPECT_EQ(found[i], static_cast<double>(i) * 7 - 20) << file;
  }
}

}  // namespace

}  // namespace adamas
