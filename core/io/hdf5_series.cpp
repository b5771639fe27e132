#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "core/base/error.h"
#include "core/io/hdf5_handle.h"
#include "core/io/hdf5_volumes.h"
#include "core/io/input_file.h"
#include "core/io/reader_program.h"
#include "core/io/volume_import.h"
#include "core/io/volume_stack.h"

namespace adamas::io {

namespace {

/// What of a file may be steps, as it is sent.
struct Found {
  std::vector<std::string> sets;  ///< those of a group; the one along four axes otherwise
  std::uint64_t count = 0;        ///< of times along the first axis; 0 of a group
  std::vector<double> times;      ///< one for each step, or none
  std::string remark{};           ///< why there are none though some are stated
};

/// The data sets along three axes of a group. Times are those of all of them, if all have one.
Found find_members(hid_t group, const std::string& path) {
  std::vector<std::string> members;
  const auto add = [](hid_t place, const char* name, const H5L_info_t*, void* found) -> herr_t {
    if (hdf5_axes(place, name) == 3) static_cast<std::vector<std::string>*>(found)->emplace_back(name);
    return 0;
  };
  H5Literate(group, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, add, &members);
  std::sort(members.begin(), members.end(), natural_less);
  Found found;
  for (const std::string& name : members) {
    const Hdf5Handle set(H5Dopen2(group, name.c_str(), H5P_DEFAULT), H5Dclose);
    const std::vector<double> time = set.good() ? hdf5_times(set.id()) : std::vector<double>();
    if (time.size() == 1) found.times.push_back(time.front());
    found.sets.push_back(path + (path.ends_with('/') ? "" : "/") + name);
  }
  if (found.times.size() == found.sets.size()) return found;
  if (!found.times.empty())
    found.remark = fmt::format("{} of {} data sets in '{}' have a time: steps are taken to be at 0, 1, 2 ...",
                               found.times.size(), found.sets.size(), path);
  found.times.clear();
  return found;
}

Found find_times_of_set(hid_t set, const std::string& path) {
  const Hdf5Handle space(H5Dget_space(set), H5Sclose);
  std::array<hsize_t, 4> size{};
  H5Sget_simple_extent_dims(space.id(), size.data(), nullptr);
  Found found{{path}, size[0], hdf5_times(set)};
  if (found.times.size() == found.count) return found;
  if (!found.times.empty())
    found.remark =
        fmt::format("'{}' has {} numbers as its time, of {} steps: these are taken to be at 0, 1, 2 ...",
                    path, found.times.size(), found.count);
  found.times.clear();
  return found;
}

Found find_steps(const std::string& name, hid_t file, const std::string& wanted) {
  const std::string path = choose_hdf5_set(name, file, wanted);
  const Hdf5Handle object(H5Oopen(file, path.c_str(), H5P_DEFAULT), H5Oclose);
  const H5I_type_t type = object.good() ? H5Iget_type(object.id()) : H5I_BADID;
  if (type == H5I_GROUP) {
    Found members = find_members(object.id(), path);
    if (members.sets.empty())
      fail("{}: expected data sets of numbers along three axes in the group '{}', found none", name, path);
    return members;
  }
  if (type == H5I_DATASET && hdf5_axes(file, path.c_str()) == 4) return find_times_of_set(object.id(), path);
  return {};
}

/// The steps with times, in their order.
VolumeSeries in_order(const std::string& name, std::vector<VolumeStep> steps, bool have_times) {
  if (!have_times) return {std::move(steps), StepTimes::kCounted};
  for (const VolumeStep& step : steps) {
    if (!std::isfinite(step.time))
      fail("{}: expected finite times, found {} as the time of '{}'", name, step.time, step.array);
  }
  std::stable_sort(steps.begin(), steps.end(),
                   [](const VolumeStep& a, const VolumeStep& b) { return a.time < b.time; });
  for (std::size_t n = 1; n < steps.size(); ++n) {
    if (steps[n].time == steps[n - 1].time)
      fail("{}: expected another time for each step, found {} twice, of '{}' and '{}'", name, steps[n].time,
           steps[n - 1].array, steps[n].array);
  }
  return {std::move(steps), StepTimes::kAbsolute};
}

}  // namespace

void send_hdf5_steps(const ReaderRequest& request, ByteSink& sink) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  const Hdf5Handle file(H5Fopen(request.paths.front().c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose);
  if (!file.good()) fail("{}: expected a whole HDF5 file, found something else", request.name);
  const Found found = find_steps(request.name, file.id(), request.array);
  sink.put(static_cast<std::uint64_t>(found.sets.size()));
  for (const std::string& set : found.sets) sink.put(set);
  sink.put(found.count);
  sink.put(found.times);
  sink.put(found.remark);
}

VolumeSeries find_hdf5_series(const std::filesystem::path& path, const std::string& array) {
  const std::string name = path.string();
  const std::uint64_t size = check_input_file(path);
  Found found;
  read_in_child({LibraryReader::kHdf5Steps, name, size, {name}, array}, [&found](ByteSource& bytes) {
    const auto sets = bytes.get<std::uint64_t>();
    for (std::uint64_t n = 0; n < sets; ++n) found.sets.push_back(bytes.get_string());
    found.count = bytes.get<std::uint64_t>();
    found.times = bytes.get_vector<double>();
    found.remark = bytes.get_string();
  });
  std::vector<VolumeStep> steps;
  const bool of_one = found.count > 0 && found.sets.size() == 1;
  if (found.count > kMostVolumeSteps)
    fail("{}: expected at most {} times, found {}", name, kMostVolumeSteps, found.count);
  for (std::uint64_t n = 0; n < (of_one ? found.count : found.sets.size()); ++n) {
    VolumeStep step{static_cast<double>(n), found.sets[of_one ? 0 : n], {}};
    if (of_one) step.number = n;
    if (found.times.size() > n) step.time = found.times[n];
    steps.push_back(step);
  }
  const bool have_times = found.times.size() == steps.size();
  VolumeSeries series = in_order(name, std::move(steps), have_times);
  if (!found.remark.empty()) series.remark = name + ": " + found.remark;
  return series;
}

}  // namespace adamas::io
