#!/usr/bin/env python3
"""Makes fuzz/seeds/NAME/*: small inputs of every kind, from which fuzzing starts.

    fuzz/seeds.py            needs Python's own library only and, for video containers, the program ffmpeg

Run it again after a new kind of model or file is added, and commit the files.
"""
import pathlib, random, shutil, struct, subprocess, tempfile, zlib

ROOT = pathlib.Path(__file__).resolve().parent
SEEDS = ROOT / "seeds"


def put(name, file, data):
    folder = SEEDS / name
    folder.mkdir(parents=True, exist_ok=True)
    (folder / file).write_bytes(data if isinstance(data, bytes) else data.encode())


def models():
    """The bytes behind the 32-byte header of each model in the tests: the fuzzer makes the header itself."""
    for path in sorted((ROOT.parent / "tests/model/golden").glob("*.wisp")):
        put("model", path.stem, path.read_bytes()[32:])


def tables():
    own = "# wisp-recording 1\n# rate_hz 30\n"
    put("csv", "own", own + "# knots 0 0 0 0 1 1 1 1\nepisode,u:u[m/s],y:y[px],m:base.x,flag:filled\n0,0.5,1e-3,7,0\n4,,2,7,1\n")
    put("csv", "plain", "\xef\xbb\xbftime, \"u\",y\r\n12:00,1,2\r\n12:01,+3,-4.5e2\r\n".encode("latin-1"))
    put("csv", "german", 'sep=;\nZeit;u;"y"\ns;N;m\n0;1,5;2\n1;NA;-3e-4;\n')
    put("csv", "blanks", "  1.0000e+00   4.0D+00\n   2.5  NaN\n")
    put("csv", "tabs", "u\ty\n1\t2,5\n3\t4\n")
    put("csv", "quotes", 'note,"u","y"\n"a, ""b""",1,"2,5"\n')
    put("csv", "bytes", bytes(range(256)))


def sounds():
    def chunk(name, body):
        return name + struct.pack("<I", len(body)) + body + b"\0" * (len(body) % 2)

    for name, tag, bits, data in (
        ("pcm16", 1, 16, struct.pack("<8h", *range(-4, 4))),
        ("pcm8", 1, 8, bytes(range(120, 129))),
        ("pcm24", 1, 24, bytes(range(12))),
        ("float32", 3, 32, struct.pack("<4f", 0, 0.5, -1, float("nan"))),
        ("float64", 3, 64, struct.pack("<2d", 0.25, -1e300)),
    ):
        form = struct.pack("<HHIIHH", tag, 1, 8000, 8000 * bits // 8, bits // 8, bits)
        body = b"WAVE" + chunk(b"fmt ", form) + chunk(b"LIST", b"note") + chunk(b"data", data)
        put("video", f"{name}.wav", b"RIFF" + struct.pack("<I", len(body)) + body)
    wide = struct.pack("<HHIIHHHHI", 0xFFFE, 3, 8000, 48000, 6, 16, 22, 16, 0) + struct.pack("<H", 1)
    wide += b"\0\0\0\0\x10\0\x80\0\0\xaa\0\x38\x9b\x71"
    body = b"WAVE" + chunk(b"fmt ", wide) + chunk(b"data", b"\0" * 12)
    put("video", "extensible.wav", b"RIFF" + struct.pack("<I", len(body)) + body)


def matrices():
    def part(kind, data):
        return struct.pack("<II", kind, len(data)) + data + b"\0" * (-len(data) % 8)

    def array(kind, rows, columns, name, rest):
        return part(14, part(6, struct.pack("<II", kind, 0)) + part(5, struct.pack("<ii", rows, columns)) + part(1, name) + rest)

    numbers = part(9, struct.pack("<6d", *range(6)))
    plain = array(6, 3, 2, b"u", numbers) + array(10, 2, 1, b"k", part(3, struct.pack("<2h", -7, 9)))
    fields = part(5, struct.pack("<i", 8)) + part(1, b"u".ljust(8, b"\0") + b"y".ljust(8, b"\0"))
    nested = array(2, 1, 1, b"data", fields + array(6, 3, 2, b"", numbers) + array(2, 1, 1, b"", fields + array(6, 6, 1, b"", numbers) * 2))
    packed = zlib.compress(array(6, 1, 6, b"packed", numbers))
    small = array(6, 1, 2, b"s", struct.pack("<HH4B", 2, 2, 1, 2, 0, 0))
    put("mat", "plain", b"\0" + plain)
    put("mat", "nested", b"\0" + nested + small)
    put("mat", "packed", b"\0" + struct.pack("<II", 15, len(packed)) + packed)


def ppm(width, height, kind=b"P6"):
    return kind + b"\n%d %d\n255\n" % (width, height) + bytes((x * 7) % 256 for x in range(width * height * (3 if kind == b"P6" else 1)))


def png(width, height):
    def chunk(name, body):
        return struct.pack(">I", len(body)) + name + body + struct.pack(">I", zlib.crc32(name + body))

    rows = b"".join(b"\0" + bytes((x + y) % 256 for x in range(width)) for y in range(height))
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def folders():
    def image(kind, number, data):
        return struct.pack("<BHH", kind, number, len(data)) + data

    put("images", "pgm", image(2, 1, ppm(16, 8, b"P5")) + image(2, 2, ppm(16, 8, b"P5")))
    put("images", "mixed", image(0, 1, png(16, 8)) + image(3, 5, ppm(16, 8)) + image(0x83, 9, ppm(16, 8)))
    bmp = b"BM" + struct.pack("<IHHI", 54 + 96, 0, 0, 54) + struct.pack("<IiiHHIIiiII", 40, 8, 4, 1, 24, 0, 96, 0, 0, 0, 0) + bytes(96)
    put("images", "bmp", image(4, 1, bmp) + image(4, 2, bmp))


def clips():
    raw = b"YUV4MPEG2 W16 H16 F25:1 Ip A1:1 C420jpeg\n" + b"".join(b"FRAME\n" + bytes([k * 20]) * 256 + b"\x80" * 128 for k in range(4))
    put("video", "raw.y4m", raw)
    if not shutil.which("ffmpeg"):
        return
    with tempfile.TemporaryDirectory() as folder:
        source = pathlib.Path(folder) / "raw.y4m"
        source.write_bytes(raw)
        for name, options in (("h264.mp4", "-c:v libx264 -c:a aac"), ("vp9.webm", "-c:v libvpx -c:a libopus"), ("ffv1.mkv", "-c:v ffv1 -c:a flac"), ("mjpeg.avi", "-c:v mjpeg -c:a pcm_s16le"), ("mpeg.ts", "-c:v mpeg2video -c:a mp2")):
            out = pathlib.Path(folder) / name
            made = subprocess.run(["ffmpeg", "-v", "quiet", "-y", "-i", str(source), "-f", "lavfi", "-i", "sine=300:duration=0.16:sample_rate=48000", *options.split(), "-fflags", "+bitexact", "-flags", "+bitexact", str(out)], stdin=subprocess.DEVNULL)
            if made.returncode == 0:
                put("video", name, out.read_bytes())


def calls():
    chance = random.Random(1)
    for name, length, count in (("bank", 300, 15), ("c", 400, 8), ("wind", 600, 4)):
        for k in range(count):
            head = bytes([k, 3]) if name == "bank" else b""
            put(name, f"random{k:02}", head + chance.randbytes(length))
    quiet = bytes([2, 0, 15, 57, 0, 4, 1, 9, 20, 1]) + bytes(int(128 + 60 * (k % 7 - 3)) % 256 for k in range(800))
    put("wind", "tone", quiet)


if __name__ == "__main__":
    for make in (models, tables, sounds, matrices, folders, clips, calls):
        make()
