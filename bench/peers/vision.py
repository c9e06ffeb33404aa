#!/usr/bin/env python3
"""Capture beside its peers, in one run: the vision stage against OpenCV on the same frames, and the whole of
`wisp capture flame` against bare decoding by ffmpeg. One thread each; medians.

  python3 bench/peers/vision.py BIN_FOLDER CLIP        needs python3-opencv and ffmpeg
"""

import json
import os
import statistics
import subprocess
import sys
import tempfile
import time

import cv2

REPEATS = 5


def run_measured(command):
    """Processor seconds and largest resident megabytes of one run of a program, by itself."""
    child = subprocess.Popen(command, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    _, status, usage = os.wait4(child.pid, 0)
    child.returncode = os.waitstatus_to_exitcode(status)
    if child.returncode != 0:
        raise subprocess.CalledProcessError(child.returncode, command)
    return usage.ru_utime + usage.ru_stime, usage.ru_maxrss / 1024


def opencv_ms(clip):
    """Otsu's threshold, Sobel in both directions and contours, on gray frames that are already decoded."""
    cv2.setNumThreads(1)
    video = cv2.VideoCapture(clip)
    frames = []
    while True:
        more, frame = video.read()
        if not more:
            break
        frames.append(cv2.cvtColor(frame, cv2.COLOR_BGR2GRAY))
    times = []
    for _ in range(3):
        start = time.process_time()
        for gray in frames:
            _, mask = cv2.threshold(gray, 0, 255, cv2.THRESH_BINARY | cv2.THRESH_OTSU)
            cv2.Sobel(gray, cv2.CV_16S, 1, 0)
            cv2.Sobel(gray, cv2.CV_16S, 0, 1)
            cv2.findContours(mask, cv2.RETR_EXTERNAL, cv2.CHAIN_APPROX_NONE)
        times.append(1e3 * (time.process_time() - start) / len(frames))
    return statistics.median(times), len(frames)


def programs(binaries, clip):
    """Runs both programs before frames are held here: a child's largest memory begins with its parent's."""
    with tempfile.TemporaryDirectory() as folder:
        capture = [os.path.join(binaries, "wisp"), "capture", "flame", clip, "-o", os.path.join(folder, "rec.csv")]
        decode = ["ffmpeg", "-threads", "1", "-i", clip, "-f", "null", "-"]
        return [(run_measured(capture), run_measured(decode)) for _ in range(REPEATS)]


def main():
    binaries, clip = sys.argv[1:3]
    pairs = programs(binaries, clip)
    ours = json.loads(subprocess.run([os.path.join(binaries, "wisp_bench_stage"), clip], check=True, capture_output=True, text=True).stdout)
    theirs, frames = opencv_ms(clip)
    print(f"{os.path.basename(clip)}, {frames} frames, OpenCV {cv2.__version__}, one thread")
    print(f"vision stage: wisp {ours['ms_per_frame']:.3f} ms a frame, OpenCV {theirs:.3f}, ratio {ours['ms_per_frame'] / theirs:.3f}")
    ours_ms = 1e3 * statistics.median(a[0] for a, _ in pairs) / frames
    theirs_ms = 1e3 * statistics.median(b[0] for _, b in pairs) / frames
    ratio = statistics.median(a[0] / b[0] for a, b in pairs)
    print(f"whole capture, processor time: wisp {ours_ms:.3f} ms a frame, ffmpeg decoding alone {theirs_ms:.3f}, ratio {ratio:.2f}")
    print(f"largest memory: wisp {max(a[1] for a, _ in pairs):.0f} MB, ffmpeg {max(b[1] for _, b in pairs):.0f} MB")


if __name__ == "__main__":
    main()
