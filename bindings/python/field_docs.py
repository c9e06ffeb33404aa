"""Extracts the headers' comments on fields of structs, as a C++ table for help(): field_docs.py HEADER… > OUT

A field without a comment takes that of its type, of a field of the same name elsewhere, or of the field above it.
"""

import pathlib
import re
import sys

docs, bare, types, before = {}, {}, {}, {}
for path in sys.argv[1:]:
    struct, field, above = "", "", []
    for line in pathlib.Path(path).read_text(encoding="utf-8").splitlines():
        opened = re.match(r"(?:struct|enum class) (\w+)", line)
        if opened:
            struct, field = opened.group(1), ""
            types[struct] = " ".join(above)
        said = re.match(r"///\s*(.*)$", line)
        above = [*above, said.group(1)] if said else []
        declared = re.match(r"  (?:([\w:<>, ]+) )?(\w+)(?:\{.*\}|(?: = [^;]*))?;\s*(?:///<\s*(.*))?$", line)
        more = re.match(r"\s+///<\s*(.*)$", line)
        if declared:
            before[f"{struct}.{declared.group(2)}"] = field
            field = f"{struct}.{declared.group(2)}"
            if declared.group(3):
                docs[field] = declared.group(3)
            else:
                bare[field] = declared.group(1)
        elif more and field:
            docs[field] = (docs.get(field, "") + " " + more.group(1)).strip()
for field, kind in bare.items():
    name = field.partition(".")[2]
    others = [words for other, words in docs.items() if other.endswith("." + name)]
    words = types.get(kind) or next(iter(others), docs.get(before[field]))
    if field not in docs and words:
        docs[field] = words
print("constexpr std::pair<std::string_view, const char*> kFieldDocs[] = {")
for name, words in docs.items():
    print('    {"%s", R"~(%s)~"},' % (name, words))
print("};")
