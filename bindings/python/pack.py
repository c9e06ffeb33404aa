"""Packs the package, its stubs and its licence into a wheel (PEP 427): pack.py FOLDER-OF-THE-PACKAGE TARGET"""

import base64
import hashlib
import pathlib
import sys
import sysconfig
import zipfile

root = pathlib.Path(__file__).resolve().parents[2]
built, target = map(pathlib.Path, sys.argv[1:])
suffix = sysconfig.get_config_var("EXT_SUFFIX")
extensions = [built / "wisp" / f"{name}{suffix}" for name in ("_wisp", "_capture")]
for extension in extensions:
    if not extension.exists():
        sys.exit(f"pack.py: {extension} is not there; expected it as this Python's own build names it")

sys.path.insert(0, str(built))
import wisp  # noqa: E402  (it knows its version)

version = wisp.__version__
tag = f"cp{sys.version_info[0]}{sys.version_info[1]}"
tags = f"{tag}-{tag}-{sysconfig.get_platform().replace('-', '_').replace('.', '_')}"
info = f"wispflame-{version}.dist-info"
metadata = f"""Metadata-Version: 2.1
Name: wispflame
Version: {version}
Summary: Learns how a thing behaves from recordings of it, and plays that behaviour live
License: MIT
Requires-Python: >=3.9
Requires-Dist: numpy
"""
files = {
    **{f"wisp/{extension.name}": extension.read_bytes() for extension in extensions},
    **{f"wisp/{name}": (root / "bindings/python/wisp" / name).read_bytes()
       for name in ("__init__.py", "__init__.pyi", "py.typed")},
    f"{info}/METADATA": metadata.encode(),
    f"{info}/WHEEL": f"Wheel-Version: 1.0\nGenerator: pack.py\nRoot-Is-Purelib: false\nTag: {tags}\n".encode(),
    f"{info}/LICENSE": (root / "LICENSE").read_bytes(),
    f"{info}/NOTICES.txt": (root / "third_party/NOTICES.txt").read_bytes(),
    f"{info}/LICENSE.Apache-2.0": (root / "third_party/flatbuffers/LICENSE").read_bytes(),
}
record = f"{info}/RECORD"
lines = [
    f"{name},sha256={base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b'=').decode()},{len(data)}"
    for name, data in files.items()
]
files[record] = "\n".join([*lines, f"{record},,", ""]).encode()

wheel = target / f"wispflame-{version}-{tags}.whl"
with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as archive:
    for name, data in files.items():
        archive.writestr(name, data)
print(wheel)
