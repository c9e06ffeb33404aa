// Documentation of fields from the library's headers, extracted by field_docs.py.

#include <utility>

#include "module.hpp"

namespace wisp::python {
namespace {

#include "field_docs.inc"

}  // namespace

const char* doc_of(std::string_view type, std::string_view field) {
  const std::string name = std::string(type) + "." + std::string(field);
  for (const auto& [known, words] : kFieldDocs) {
    if (known == name) return words;
  }
  return "";
}

}  // namespace wisp::python
