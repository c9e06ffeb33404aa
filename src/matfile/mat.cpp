#include "wisp/record/mat.hpp"

#include <hdf5.h>
#include <matio.h>

#include <cmath>
#include <cstdint>
#include <memory>
#include <optional>

#include "level5.hpp"

namespace wisp {
namespace {

struct Close {
  void operator()(mat_t* file) const { Mat_Close(file); }
  void operator()(matvar_t* variable) const { Mat_VarFree(variable); }
};
using File = std::unique_ptr<mat_t, Close>;
using Variable = std::unique_ptr<matvar_t, Close>;

// While it lives HDF5 prints nothing about what it finds wrong: that is ours to say.
class QuietHdf5 {
 public:
  QuietHdf5() {
    H5Eget_auto2(H5E_DEFAULT, &report_, &client_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  ~QuietHdf5() { H5Eset_auto2(H5E_DEFAULT, report_, client_); }
  QuietHdf5(const QuietHdf5&) = delete;
  QuietHdf5& operator=(const QuietHdf5&) = delete;

 private:
  H5E_auto2_t report_ = nullptr;
  void* client_ = nullptr;
};

// A gigabyte of doubles: more is a damaged size, or a recording that wants another form.
constexpr std::size_t kMostNumbers = std::size_t{1} << 27;

Result<File> open(const std::filesystem::path& path) {
  if (!std::filesystem::is_regular_file(path)) return Error{path.string() + ": there is no such file"};
  File file(Mat_Open(path.c_str(), MAT_ACC_RDONLY));
  // What is neither level 5 nor 7.3 is taken for level 4, which has no mark of its own and could be anything.
  if (!file || (Mat_GetVersion(file.get()) != MAT_FT_MAT5 && Mat_GetVersion(file.get()) != MAT_FT_MAT73)) {
    return Error{path.string() + ": this is not a MATLAB file of level 5 or 7.3; save it with -v7 or -v7.3"};
  }
  if (Mat_GetVersion(file.get()) == MAT_FT_MAT5 && !level5_is_whole(path)) {
    return Error{path.string() + ": the file is cut short or damaged: its parts do not end where it ends"};
  }
  return file;
}

bool numeric(const matvar_t& variable) {
  const bool full = variable.class_type >= MAT_C_DOUBLE && variable.class_type <= MAT_C_UINT64;
  return full && variable.rank == 2 && variable.dims != nullptr && !variable.isComplex;
}

std::string size_of(const matvar_t& variable) {
  return " (" + std::to_string(variable.dims[0]) + " × " + std::to_string(variable.dims[1]) + ")";
}

void list_fields(matvar_t& structure, const std::string& prefix, std::vector<std::string>& names) {
  if (structure.rank != 2 || structure.dims == nullptr || structure.dims[0] * structure.dims[1] != 1) return;
  char* const* fields = Mat_VarGetStructFieldnames(&structure);
  for (unsigned k = 0; k < Mat_VarGetNumberOfFields(&structure); ++k) {
    matvar_t* field = Mat_VarGetStructFieldByIndex(&structure, k, 0);
    // A damaged structure can have fields without names, or no list of names at all.
    if (field == nullptr || fields == nullptr || fields[k] == nullptr) continue;
    const std::string name = prefix + "." + fields[k];
    if (numeric(*field)) names.push_back(name + size_of(*field));
    if (field->class_type == MAT_C_STRUCT) list_fields(*field, name, names);
  }
}

std::vector<std::string> list_variables(mat_t& file) {
  std::vector<std::string> names;
  Mat_Rewind(&file);
  while (const Variable variable{Mat_VarReadNextInfo(&file)}) {
    if (variable->name == nullptr) continue;
    if (numeric(*variable)) names.push_back(variable->name + size_of(*variable));
    if (variable->class_type == MAT_C_STRUCT) list_fields(*variable, variable->name, names);
  }
  return names;
}

// A reference such as `data.u(:,2)`, taken apart.
struct Reference {
  std::vector<std::string> path;  // variable, then fields
  std::optional<std::size_t> column;
};

std::optional<Reference> parse(std::string text) {
  Reference reference;
  if (text.ends_with(")")) {
    const std::size_t open = text.find("(:,");
    if (open == std::string::npos) return std::nullopt;
    const std::string digits = text.substr(open + 3, text.size() - open - 4);
    if (digits.empty() || digits.size() > 6 || digits.find_first_not_of("0123456789") != std::string::npos) {
      return std::nullopt;
    }
    reference.column = std::stoul(digits);
    text.resize(open);
  }
  for (std::size_t begin = 0; begin <= text.size();) {
    const std::size_t end = std::min(text.find('.', begin), text.size());
    if (end == begin) return std::nullopt;
    reference.path.push_back(text.substr(begin, end - begin));
    begin = end + 1;
  }
  return reference;
}

template <class Number>
void append(const void* data, std::size_t count, std::vector<double>& out) {
  const auto* numbers = static_cast<const Number*>(data);
  out.insert(out.end(), numbers, numbers + count);
}

// All numbers, column after column; nothing where the class is not known.
std::vector<double> numbers_of(const matvar_t& variable) {
  const std::size_t count = variable.dims[0] * variable.dims[1];
  std::vector<double> out;
  out.reserve(count);
  switch (variable.data_type) {
    case MAT_T_DOUBLE:
      append<double>(variable.data, count, out);
      break;
    case MAT_T_SINGLE:
      append<float>(variable.data, count, out);
      break;
    case MAT_T_INT8:
      append<std::int8_t>(variable.data, count, out);
      break;
    case MAT_T_UINT8:
      append<std::uint8_t>(variable.data, count, out);
      break;
    case MAT_T_INT16:
      append<std::int16_t>(variable.data, count, out);
      break;
    case MAT_T_UINT16:
      append<std::uint16_t>(variable.data, count, out);
      break;
    case MAT_T_INT32:
      append<std::int32_t>(variable.data, count, out);
      break;
    case MAT_T_UINT32:
      append<std::uint32_t>(variable.data, count, out);
      break;
    case MAT_T_INT64:
      append<std::int64_t>(variable.data, count, out);
      break;
    case MAT_T_UINT64:
      append<std::uint64_t>(variable.data, count, out);
      break;
    default:
      break;
  }
  return out;
}

struct Table {
  std::size_t rows = 0;
  std::size_t columns = 0;
  std::vector<double> numbers;  // column after column
};

// Sizes are checked before anything is read: a damaged file may claim any.
bool sane(const matvar_t& info) {
  if (!numeric(info)) return false;
  const std::size_t rows = info.dims[0];
  const std::size_t columns = info.dims[1];
  return rows > 0 && columns > 0 && rows <= kMostNumbers && columns <= kMostNumbers / rows;
}

class Reader {
 public:
  Reader(mat_t& file, const std::filesystem::path& path) : file_(file), path_(path) {}

  Result<Table> table(const std::string& name) const {
    const auto reference = parse(name);
    if (!reference) return at(name, "expected a variable such as u, data.u or u(:,2)");
    Variable variable(Mat_VarReadInfo(&file_, reference->path.front().c_str()));
    if (!variable) return at(name, "there is no such variable; the file has: " + names());
    if (reference->path.size() == 1 && !sane(*variable)) return not_numbers(name);
    if (Mat_VarReadDataAll(&file_, variable.get()) != 0) return at(name, "its data is damaged or cut short");
    const matvar_t* found = variable.get();
    for (std::size_t k = 1; k < reference->path.size() && found != nullptr; ++k) {
      found = found->class_type == MAT_C_STRUCT
                  ? Mat_VarGetStructFieldByName(const_cast<matvar_t*>(found), reference->path[k].c_str(), 0)
                  : nullptr;
    }
    if (found == nullptr) return at(name, "there is no such field; the file has: " + names());
    if (!sane(*found)) return not_numbers(name);
    if (found->data == nullptr) return at(name, "its data is damaged or cut short");
    Table table{found->dims[0], found->dims[1], numbers_of(*found)};
    if (table.numbers.empty()) return not_numbers(name);
    if (table.rows == 1) std::swap(table.rows, table.columns);
    if (!reference->column) return table;
    if (*reference->column < 1 || *reference->column > table.columns) {
      return at(name, "the variable has " + std::to_string(table.columns) + " columns");
    }
    const auto first = table.numbers.begin() + static_cast<std::ptrdiff_t>((*reference->column - 1) * table.rows);
    return Table{table.rows, 1, {first, first + static_cast<std::ptrdiff_t>(table.rows)}};
  }

  std::optional<double> scalar(const char* name) const {
    Variable variable(Mat_VarReadInfo(&file_, name));
    if (!variable || !sane(*variable) || variable->dims[0] * variable->dims[1] != 1) return std::nullopt;
    if (Mat_VarReadDataAll(&file_, variable.get()) != 0 || variable->data == nullptr) return std::nullopt;
    const auto numbers = numbers_of(*variable);
    if (numbers.empty() || !std::isfinite(numbers[0]) || !(numbers[0] > 0)) return std::nullopt;
    return numbers[0];
  }

  Error at(const std::string& name, const std::string& what) const {
    return Error{path_.string() + ", variable " + name + ": " + what};
  }

 private:
  Error not_numbers(const std::string& name) const {
    return at(name, "expected a real, full, numeric vector or matrix of two dimensions");
  }

  std::string names() const {
    std::string list;
    for (const std::string& name : list_variables(file_)) list += (list.empty() ? "" : ", ") + name;
    return list.empty() ? "nothing numeric" : list;
  }

  mat_t& file_;
  const std::filesystem::path& path_;
};

Result<void> add_channels(const Reader& reader, const std::string& name, Role role, Recording& recording) {
  auto table = reader.table(name);
  if (!table) return table.error();
  if (!recording.channels.empty() && table->rows != recording.rows()) {
    return reader.at(name, "it has " + std::to_string(table->rows) + " samples, " + recording.channels.front().name +
                               " has " + std::to_string(recording.rows()));
  }
  for (std::size_t c = 0; c < table->columns; ++c) {
    Channel channel;
    channel.name = table->columns == 1 ? name : name + std::to_string(c + 1);
    channel.role = role;
    const auto first = table->numbers.begin() + static_cast<std::ptrdiff_t>(c * table->rows);
    channel.samples.assign(first, first + static_cast<std::ptrdiff_t>(table->rows));
    for (std::size_t t = 0; t < channel.samples.size(); ++t) {
      if (std::isinf(channel.samples[t])) return reader.at(name, "sample " + std::to_string(t + 1) + " is infinite");
    }
    recording.channels.push_back(std::move(channel));
  }
  return {};
}

}  // namespace

Result<Recording> read_mat(const std::filesystem::path& path, const MatOptions& options) {
  const QuietHdf5 quiet;
  const auto file = open(path);
  if (!file) return file.error();
  if (options.inputs.empty() && options.outputs.empty()) {
    std::string list;
    for (const std::string& name : list_variables(**file)) list += (list.empty() ? "" : ", ") + name;
    return Error{path.string() + ": name the variables that are inputs and outputs; the file has: " + list};
  }
  const Reader reader(**file, path);
  Recording recording;
  recording.source = path.string();
  recording.rate_hz = options.rate_hz;
  if (recording.rate_hz == 0) {
    if (const auto seconds = reader.scalar("Ts")) recording.rate_hz = 1 / *seconds;
    if (const auto rate = reader.scalar("fs")) recording.rate_hz = *rate;
  }
  if (!(recording.rate_hz > 0) || !std::isfinite(recording.rate_hz)) {
    return Error{path.string() + ": no rate; give it, or store a scalar Ts (seconds) or fs (samples a second)"};
  }
  for (const auto& [names, role] : {std::pair{&options.inputs, Role::kInput}, {&options.outputs, Role::kOutput}}) {
    for (const std::string& name : *names) {
      if (auto ok = add_channels(reader, name, role, recording); !ok) return ok.error();
    }
  }
  if (auto ok = check(recording); !ok) return Error{path.string() + ": " + ok.error().message};
  return recording;
}

Result<std::vector<std::string>> list_mat(const std::filesystem::path& path) {
  const QuietHdf5 quiet;
  const auto file = open(path);
  if (!file) return file.error();
  return list_variables(**file);
}

}  // namespace wisp
