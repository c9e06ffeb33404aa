"""Reads what the library's headers say of each field of a struct, as a C++ table for help(): field_docs.py HEADER… > OUT"""

import pathlib
import re
import sys

print("constexpr std::pair<std::string_view, const char*> kFieldDocs[] = {")
for path in sys.argv[1:]:
    struct, field = "", ""
    docs = {}
    for line in pathlib.Path(path).read_text(encoding="utf-8").splitlines():
        opened = re.match(r"struct (\w+)", line)
        struct = opened.group(1) if opened else struct
        declared = re.match(r"  (?:[\w:<>, ]+ )?(\w+)(?:\{.*\}|(?: = [^;]*))?;\s*(?:///<\s*(.*))?$", line)
        more = re.match(r"\s+///<\s*(.*)$", line)
        if declared:
            field = f"{struct}.{declared.group(1)}"
            if declared.group(2):
                docs[field] = declared.group(2)
        elif more and field:
            docs[field] = (docs.get(field, "") + " " + more.group(1)).strip()
    for name, words in docs.items():
        print('    {"%s", R"~(%s)~"},' % (name, words))
print("};")
