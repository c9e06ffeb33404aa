"""Packs the package, and the extension that reads films, into two wheels (PEP 427): pack.py FOLDER-OF-THE-PACKAGE TARGET

The first wheel links only libraries that every Linux has, and so gets a manylinux tag; the second links FFmpeg.
"""

import base64
import hashlib
import pathlib
import re
import subprocess
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
import wisp  # noqa: E402  (for its version)

version = wisp.__version__
tag = f"cp{sys.version_info[0]}{sys.version_info[1]}"
# Libraries that a manylinux wheel may link (PEP 600), present in every distribution of its age.
everywhere = {"libc.so.6", "libm.so.6", "libgcc_s.so.1", "libstdc++.so.6", "libpthread.so.0", "libdl.so.2", "librt.so.1"}


def platform_of(extension):
    """The platform tag: manylinux with the oldest sufficient glibc if it links only `everywhere`, else this machine's."""
    here = sysconfig.get_platform().replace("-", "_").replace(".", "_")
    if not here.startswith("linux_"):
        return here
    needed = re.findall(r"NEEDED.*\[(.*)\]", subprocess.run(["readelf", "-d", extension], check=True, capture_output=True,
                                                            text=True).stdout)
    if any(name not in everywhere and not name.startswith("ld-linux") for name in needed):
        return here
    minors = [int(minor) for minor in re.findall(rb"GLIBC_2\.(\d+)(?:\.\d+)?\0", extension.read_bytes())]
    return f"manylinux_2_{max(minors)}_{here.removeprefix('linux_')}"


def pack(name, extension, summary, needs, more=()):
    """Writes one wheel: an extension, further files of the package, and licences. Replaces older wheels of that name."""
    tags = f"{tag}-{tag}-{platform_of(extension)}"
    info = f"{name}-{version}.dist-info"
    metadata = f"""Metadata-Version: 2.1
Name: {name.replace('_', '-')}
Version: {version}
Summary: {summary}
License: MIT
Requires-Python: >=3.9
{needs}
"""
    files = {
        f"wisp/{extension.name}": extension.read_bytes(),
        **{f"wisp/{part}": (root / "bindings/python/wisp" / part).read_bytes() for part in more},
        f"{info}/METADATA": metadata.encode(),
        f"{info}/WHEEL": f"Wheel-Version: 1.0\nGenerator: pack.py\nRoot-Is-Purelib: false\nTag: {tags}\n".encode(),
        f"{info}/LICENSE": (root / "LICENSE").read_bytes(),
        f"{info}/NOTICES.txt": (root / "third_party/NOTICES.txt").read_bytes(),
        f"{info}/LICENSE.Apache-2.0": (root / "third_party/flatbuffers/LICENSE").read_bytes(),
    }
    record = f"{info}/RECORD"
    lines = [
        f"{part},sha256={base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b'=').decode()},{len(data)}"
        for part, data in files.items()
    ]
    files[record] = "\n".join([*lines, f"{record},,", ""]).encode()
    for old in target.glob(f"{name}-*.whl"):
        old.unlink()
    wheel = target / f"{name}-{version}-{tags}.whl"
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for part, data in files.items():
            archive.writestr(part, data)
    print(wheel)


core, capture = extensions
pack("wispflame", core, "Learns how a thing behaves from recordings of it, and plays that behaviour live",
     'Requires-Dist: numpy\nProvides-Extra: capture\nRequires-Dist: wispflame-capture; extra == "capture"',
     ("__init__.py", "__init__.pyi", "py.typed"))
pack("wispflame_capture", capture, "Films for wispflame: needs FFmpeg's libraries", f"Requires-Dist: wispflame (=={version})")
