#include "adamas/output_set.h"

#include <algorithm>
#include <cctype>

#include "adamas/text.h"
#include "core/base/error.h"
#include "core/base/output_file.h"
#include "core/io/referred_files.h"

namespace adamas {

using namespace io;

namespace {

std::string lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(),
                 [](char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); });
  return text;
}

void check_extension(const std::string& option, const std::filesystem::path& path,
                     const std::vector<const char*>& extensions) {
  if (extensions.empty()) return;
  const std::string name = lower_case(path.filename().string());
  std::string known;
  for (const char* extension : extensions) {
    if (name.size() > std::string_view(extension).size() && name.ends_with(extension)) return;
    known += (known.empty() ? "" : ", ") + std::string(extension);
  }
  wrong_usage("{}: expected a file name that ends in {}, found '{}'", option, known, path.string());
}

/// Throws Error (kUsage) if both names are of the same file.
void check_apart(const std::string& option, const std::filesystem::path& output,
                 const std::filesystem::path& input) {
  std::error_code code;
  if (std::filesystem::equivalent(output, input, code)) {
    wrong_usage("{}: expected a file that is no input, found {}", option, output.string());
  }
}

}  // namespace

OutputSet::OutputSet() = default;
OutputSet::~OutputSet() = default;

void OutputSet::check_outputs_apart_from(const std::filesystem::path& input) const {
  for (const auto& [option, file] : files_) check_apart(option, file->path(), input);
}

void OutputSet::protect(const std::filesystem::path& input) {
  check_outputs_apart_from(input);
  if (!input.empty()) inputs_.push_back(input);
  for (const auto& file : referred_files(input)) protect_other(file);
}

void OutputSet::protect_other(const std::filesystem::path& path) {
  check_outputs_apart_from(path);
  if (!path.empty()) others_.push_back(path);
}

void OutputSet::check_outside(const std::string& option, const std::filesystem::path& folder) const {
  for (const auto* files : {&inputs_, &others_}) {
    for (const auto& file : *files) {
      std::error_code code;
      const auto within = std::filesystem::relative(file, folder, code);
      if (!code && !within.empty() && *within.begin() != ".." && *within.begin() != ".")
        wrong_usage("{}: expected a folder without the input, found {} in {}", option, file.string(),
                    folder.string());
    }
  }
}

std::string OutputSet::naming_input(const std::string& message) const {
  // A name within a longer word does not count.
  const auto ends_word = [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_' && c != '-';
  };
  const auto names = [&](const std::filesystem::path& path) {
    const std::string name = path.string();
    for (std::size_t at = 0; !name.empty() && (at = message.find(name, at)) != std::string::npos; ++at) {
      const std::size_t end = at + name.size();
      if ((at == 0 || ends_word(message[at - 1])) && (end == message.size() || ends_word(message[end])))
        return true;
    }
    return false;
  };
  const bool is_named = std::any_of(inputs_.begin(), inputs_.end(), names) ||
                        std::any_of(others_.begin(), others_.end(), names) ||
                        std::any_of(files_.begin(), files_.end(),
                                    [&](const Declared& each) { return names(each.file->path()); });
  return is_named || inputs_.empty() ? message : inputs_.front().string() + ": " + message;
}

void OutputSet::declare(const std::string& option, const std::string& path,
                        const std::vector<const char*>& extensions) {
  if (path.empty()) return;
  check_extension(option, path, extensions);
  const std::filesystem::path full = std::filesystem::absolute(path).lexically_normal();
  for (const auto& [other, file] : files_) {
    if (std::filesystem::absolute(file->path()).lexically_normal() == full) {
      wrong_usage("{}: expected another name for each output, found {} twice", option, path);
    }
  }
  for (const auto& input : inputs_) check_apart(option, path, input);
  for (const auto& other : others_) check_apart(option, path, other);
  std::error_code code;
  const auto status = std::filesystem::status(path, code);
  if (std::filesystem::exists(status) && !std::filesystem::is_regular_file(status) &&
      !std::filesystem::is_directory(status)) {
    fail("{}: expected the name of a plain file, found something else there", path);
  }
  files_.push_back({option, std::make_unique<OutputFile>(path)});
}

OutputFile* OutputSet::find(const std::string& path) const {
  const auto at = std::find_if(files_.begin(), files_.end(),
                               [&path](const Declared& each) { return each.file->path() == path; });
  return at == files_.end() ? nullptr : at->file.get();
}

void OutputSet::write(const std::string& path,
                      const std::function<void(const std::filesystem::path&)>& writer) {
  const OutputFile* file = find(path);
  if (file == nullptr) return;
  try {
    writer(file->temporary());
  } catch (const Cancelled&) {
    throw;
  } catch (const Error& e) {
    throw Error(replaced(e.what(), file->temporary().string(), path), e.kind());
  }
}

void OutputSet::publish(const std::string& path,
                        const std::function<void(const std::filesystem::path&)>& writer) {
  write(path, writer);
  if (OutputFile* file = find(path)) file->publish();
}

void OutputSet::leave_out(const std::string& path) {
  std::erase_if(files_, [&path](const Declared& each) { return each.file->path() == path; });
}

std::size_t OutputSet::bytes(const std::string& path) const {
  const OutputFile* file = find(path);
  std::error_code code;
  const auto size = file == nullptr ? 0 : std::filesystem::file_size(file->temporary(), code);
  return code ? 0 : static_cast<std::size_t>(size);
}

void OutputSet::commit(const std::string& path) {
  if (OutputFile* file = find(path)) file->commit();
}

void OutputSet::commit() {
  std::vector<OutputFile*> named;
  try {
    // A file that refers to others, such as the list of a series, is declared before them and gets its name
    // after them.
    for (auto each = files_.rbegin(); each != files_.rend(); ++each) {
      each->file->commit();
      named.push_back(each->file.get());
    }
  } catch (const Error&) {
    for (OutputFile* file : named) file->undo();
    throw;
  }
  files_.clear();
}

}  // namespace adamas
