#include "zip_archive.hpp"

#include <zip.h>

#include <algorithm>
#include <array>
#include <set>
#include <stdexcept>

#include "slideway/base/error.hpp"
#include "slideway/base/text.hpp"

namespace slideway {
namespace {

constexpr std::size_t kFreeExpansion = std::size_t{1} << 20U;
constexpr std::size_t kExpansion = 100;

class ZipError {
 public:
  ZipError() { zip_error_init(&error_); }
  ~ZipError() { zip_error_fini(&error_); }
  ZipError(const ZipError&) = delete;
  ZipError& operator=(const ZipError&) = delete;
  zip_error_t* get() { return &error_; }
  std::string text() { return zip_error_strerror(&error_); }

 private:
  zip_error_t error_{};
};

struct Discard {
  void operator()(zip_t* archive) const { zip_discard(archive); }
  void operator()(zip_file_t* file) const { zip_fclose(file); }
  void operator()(zip_source_t* source) const { zip_source_free(source); }
};
using Archive = std::unique_ptr<zip_t, Discard>;
using File = std::unique_ptr<zip_file_t, Discard>;
using Source = std::unique_ptr<zip_source_t, Discard>;

std::string entry_text(std::string_view name) { return "entry '" + printable(name, 60) + "'"; }

bool leads_out(std::string_view name) {
  if (name.starts_with('/') || name.find_first_of("\\:") != std::string_view::npos) return true;
  for (std::size_t begin = 0; begin <= name.size();) {
    const std::size_t end = std::min(name.find('/', begin), name.size());
    if (name.substr(begin, end - begin) == "..") return true;
    begin = end + 1;
  }
  return false;
}

bool is_archive(std::string_view name) {
  std::string lower(name);
  for (char& c : lower)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  return lower.ends_with(".zip") || lower.ends_with(".x3p");
}

void check_names(zip_t* archive) {
  std::set<std::string, std::less<>> names;
  const zip_int64_t count = zip_get_num_entries(archive, 0);
  for (zip_int64_t i = 0; i < count; ++i) {
    const char* const name = zip_get_name(archive, static_cast<zip_uint64_t>(i), ZIP_FL_ENC_RAW);
    if (name == nullptr || *name == '\0')
      throw DataError("zip: entry " + std::to_string(i + 1) + " has no name");
    if (leads_out(name)) throw DataError("zip: " + entry_text(name) + ": its path leads out");
    if (is_archive(name))
      throw DataError("zip: " + entry_text(name) + " is an archive in the archive");
    if (!names.insert(name).second) throw DataError("zip: " + entry_text(name) + " is there twice");
  }
}

void check_size(const zip_stat_t& entry, std::size_t most, const std::string& place) {
  constexpr zip_uint64_t kNeeded = ZIP_STAT_SIZE | ZIP_STAT_COMP_SIZE | ZIP_STAT_COMP_METHOD;
  if ((entry.valid & kNeeded) != kNeeded) throw DataError(place + ": its size is not declared");
  if (entry.comp_method != ZIP_CM_STORE && entry.comp_method != ZIP_CM_DEFLATE)
    throw DataError(place + ": compression method " + std::to_string(entry.comp_method) +
                    "; accepted: 0 (stored), 8 (deflated)");
  if (entry.size > most)
    throw DataError(place + ": " + std::to_string(entry.size) + " bytes declared, at most " +
                    std::to_string(most) + " belong there");
  if (entry.size > kFreeExpansion && entry.size / kExpansion > entry.comp_size)
    throw DataError(place + ": " + std::to_string(entry.size) + " bytes declared out of " +
                    std::to_string(entry.comp_size) + ", more than " + std::to_string(kExpansion) +
                    " to 1");
}

[[noreturn]] void fail_to_write(const std::string& why) {
  throw std::runtime_error("zip archive cannot be written: " + why);
}

std::string contents(zip_source_t* source) {
  zip_stat_t stat{};
  if (zip_source_stat(source, &stat) != 0 || zip_source_open(source) != 0)
    fail_to_write(zip_error_strerror(zip_source_error(source)));
  std::string bytes(stat.size, '\0');
  const zip_int64_t count = zip_source_read(source, bytes.data(), bytes.size());
  zip_source_close(source);
  if (count != static_cast<zip_int64_t>(bytes.size())) fail_to_write("short read");
  return bytes;
}

}  // namespace

struct ZipArchive::State {
  Archive archive;
};

ZipArchive::ZipArchive(std::string_view bytes) : state_(std::make_unique<State>()) {
  ZipError error;
  Source source(zip_source_buffer_create(bytes.data(), bytes.size(), 0, error.get()));
  if (source) state_->archive.reset(zip_open_from_source(source.get(), ZIP_RDONLY, error.get()));
  if (!state_->archive)
    throw DataError("zip: no whole zip archive: " + error.text() + "; is the file cut off?");
  (void)source.release();  // belongs to the archive now
  check_names(state_->archive.get());
}

ZipArchive::~ZipArchive() = default;

bool ZipArchive::contains(const std::string& name) const {
  return zip_name_locate(state_->archive.get(), name.c_str(), ZIP_FL_ENC_RAW) >= 0;
}

std::string ZipArchive::read(const std::string& name, std::size_t most) const {
  const std::string place = "zip: " + entry_text(name);
  zip_t* const archive = state_->archive.get();
  zip_stat_t entry{};
  if (!contains(name) || zip_stat(archive, name.c_str(), ZIP_FL_ENC_RAW, &entry) != 0)
    throw DataError(place + " is missing");
  check_size(entry, most, place);

  const File file(zip_fopen_index(archive, entry.index, 0));
  if (!file) throw DataError(place + ": " + zip_error_strerror(zip_get_error(archive)));
  std::string bytes;
  std::array<char, 65536> piece;
  for (;;) {
    const zip_int64_t count = zip_fread(file.get(), piece.data(), piece.size());
    if (count < 0)
      throw DataError(place + ": " + zip_error_strerror(zip_file_get_error(file.get())));
    if (count == 0) break;
    bytes.append(piece.data(), static_cast<std::size_t>(count));
    if (bytes.size() > entry.size) break;
  }
  if (bytes.size() != entry.size)
    throw DataError(place + ": its size is not the " + std::to_string(entry.size) +
                    " bytes declared");
  return bytes;
}

std::string zip_archive(std::span<const std::pair<std::string, std::string>> files) {
  constexpr zip_uint16_t kFirstOfJanuary1980 = (1U << 5U) | 1U;
  ZipError error;
  const Source target(zip_source_buffer_create(nullptr, 0, 0, error.get()));
  if (!target) fail_to_write(error.text());
  zip_source_keep(target.get());
  Archive archive(zip_open_from_source(target.get(), ZIP_TRUNCATE, error.get()));
  if (!archive) {
    zip_source_free(target.get());
    fail_to_write(error.text());
  }
  for (const auto& [name, bytes] : files) {
    Source source(zip_source_buffer(archive.get(), bytes.data(), bytes.size(), 0));
    const zip_int64_t index =
        source ? zip_file_add(archive.get(), name.c_str(), source.get(), ZIP_FL_ENC_UTF_8) : -1;
    if (index < 0) fail_to_write(zip_strerror(archive.get()));
    (void)source.release();  // belongs to the archive now
    const auto entry = static_cast<zip_uint64_t>(index);
    if (zip_set_file_compression(archive.get(), entry, ZIP_CM_STORE, 0) != 0 ||
        zip_file_set_dostime(archive.get(), entry, 0, kFirstOfJanuary1980, 0) != 0)
      fail_to_write(zip_strerror(archive.get()));
  }
  if (zip_close(archive.get()) != 0) fail_to_write(zip_strerror(archive.get()));
  (void)archive.release();
  return contents(target.get());
}

}  // namespace slideway
