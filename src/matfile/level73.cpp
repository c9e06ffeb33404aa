#include "matfile/level73.hpp"

#include <hdf5.h>

#include <algorithm>
#include <string_view>

namespace wisp::matfile {
namespace {

static_assert(sizeof(hid_t) <= sizeof(long));

// While it lives HDF5 prints nothing about what it finds wrong: that is ours to say.
class Quiet {
 public:
  Quiet() {
    H5Eget_auto2(H5E_DEFAULT, &report_, &client_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~Quiet() { H5Eset_auto2(H5E_DEFAULT, report_, client_); }
  Quiet(const Quiet&) = delete;
  Quiet& operator=(const Quiet&) = delete;

 private:
  H5E_auto2_t report_ = nullptr;
  void* client_ = nullptr;
};

// One of HDF5's objects, closed as its kind wants it.
class Object {
 public:
  Object(hid_t id, herr_t (*close)(hid_t)) : id_(id), close_(close) {}
  ~Object() {
    if (id_ >= 0) close_(id_);
  }
  Object(const Object&) = delete;
  Object& operator=(const Object&) = delete;

  explicit operator bool() const { return id_ >= 0; }
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

// Text is stored as whole numbers.
bool is_text(hid_t data) {
  const Object made(H5Aopen(data, "MATLAB_class", H5P_DEFAULT), H5Aclose);
  if (!made) return false;
  const Object type(H5Aget_type(made), H5Tclose);
  char name[64] = {};
  if (!type || H5Tget_class(type) != H5T_STRING || H5Tis_variable_str(type) != 0) return false;
  if (H5Tget_size(type) >= sizeof name || H5Aread(made, type, name) < 0) return false;
  return std::string_view(name) == "char";
}

bool is_struct(hid_t group) { return H5Aexists(group, "MATLAB_sparse") <= 0; }

// MATLAB's dimensions are HDF5's turned about. Nothing where it is no real, full matrix of two dimensions.
bool shape_of(hid_t data, std::size_t& rows, std::size_t& columns) {
  const Object space(H5Dget_space(data), H5Sclose), type(H5Dget_type(data), H5Tclose);
  if (!space || !type || H5Aexists(data, "MATLAB_empty") > 0 || is_text(data)) return false;
  const H5T_class_t kind = H5Tget_class(type);
  hsize_t dims[2] = {};
  if (H5Sget_simple_extent_ndims(space) != 2 || H5Sget_simple_extent_dims(space, dims, nullptr) != 2) return false;
  rows = static_cast<std::size_t>(dims[1]);
  columns = static_cast<std::size_t>(dims[0]);
  return kind == H5T_FLOAT || kind == H5T_INTEGER;
}

// Whether the numbers lie in this file: a damaged or wicked one could point into any other.
bool lies_here(hid_t data) {
  const Object made(H5Dget_create_plist(data), H5Pclose);
  if (!made) return false;
  const H5D_layout_t layout = H5Pget_layout(made);
  return H5Pget_external_count(made) == 0 && layout >= 0 && layout < H5D_VIRTUAL;
}

struct Listing {
  std::vector<Name>& names;
  std::string prefix;
  int depth;
};

bool is_hard(hid_t group, const char* name) {
  H5L_info_t link;
  return H5Lget_info(group, name, &link, H5P_DEFAULT) >= 0 && link.type == H5L_TYPE_HARD;
}

extern "C" herr_t list_one(hid_t group, const char* name, const H5L_info_t* link, void* into) {
  auto& listing = *static_cast<Listing*>(into);
  if (link->type != H5L_TYPE_HARD || name[0] == '#') return 0;  // MATLAB keeps what is referred to in #refs#
  const Object found(H5Oopen(group, name, H5P_DEFAULT), H5Oclose);
  if (!found) return 0;
  const std::string full = listing.prefix + name;
  if (H5Iget_type(found) == H5I_DATASET) {
    Name entry{full, 0, 0};
    if (shape_of(found, entry.rows, entry.columns)) listing.names.push_back(entry);
  } else if (H5Iget_type(found) == H5I_GROUP && is_struct(found) && listing.depth < kDeepest) {
    Listing inner{listing.names, full + ".", listing.depth + 1};
    H5Literate(found, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, list_one, &inner);
  }
  return listing.names.size() > 10'000 ? 1 : 0;  // of a file whose groups contain themselves
}

Found numbers_of(hid_t data, std::size_t file_bytes) {
  Table table;
  if (!shape_of(data, table.rows, table.columns) || table.rows == 0 || table.columns == 0) return Miss::kNotNumbers;
  if (table.rows > kMaxNumbers || table.columns > kMaxNumbers / table.rows) return Miss::kTooLarge;
  const std::size_t count = table.rows * table.columns;
  const Object type(H5Dget_type(data), H5Tclose);
  if (!lies_here(data) || count > kMaxExpansion * file_bytes / std::max<std::size_t>(H5Tget_size(type), 1)) {
    return Miss::kDamaged;
  }
  table.numbers.resize(count);
  if (H5Dread(data, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, table.numbers.data()) < 0) return Miss::kDamaged;
  return table;
}

}  // namespace

bool is_level73(std::span<const std::byte> file) {
  return file.size() >= 128 && file[124] == std::byte{0} && file[125] == std::byte{2} && file[126] == std::byte{'I'} &&
         file[127] == std::byte{'M'};
}

std::unique_ptr<Level73> Level73::open(const std::filesystem::path& path) {
  const Quiet quiet;
  const hid_t file = H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT);
  if (file < 0) return nullptr;
  std::error_code ignored;
  return std::unique_ptr<Level73>(
      new Level73(static_cast<long>(file), static_cast<std::size_t>(std::filesystem::file_size(path, ignored))));
}

Level73::~Level73() {
  const Quiet quiet;
  H5Fclose(file_);
}

std::vector<Name> Level73::names() const {
  const Quiet quiet;
  std::vector<Name> names;
  Listing listing{names, "", 0};
  H5Literate(file_, H5_INDEX_NAME, H5_ITER_NATIVE, nullptr, list_one, &listing);
  return names;
}

Found Level73::read(const Path& path) const {
  const Quiet quiet;
  std::string place;
  for (const std::string& name : path) {
    const Miss miss = place.empty() ? Miss::kNoVariable : Miss::kNoField;
    const Object above(H5Oopen(file_, place.empty() ? "/" : place.c_str(), H5P_DEFAULT), H5Oclose);
    if (!above || H5Iget_type(above) != H5I_GROUP || name.find('/') != std::string::npos) return miss;
    if (H5Lexists(above, name.c_str(), H5P_DEFAULT) <= 0 || !is_hard(above, name.c_str())) return miss;
    place += "/" + name;
  }
  const Object found(H5Oopen(file_, place.c_str(), H5P_DEFAULT), H5Oclose);
  if (!found || H5Iget_type(found) != H5I_DATASET) return Miss::kNotNumbers;
  return numbers_of(found, bytes_);
}

}  // namespace wisp::matfile
