#!/usr/bin/env python3
"""Measured time series from Debian packages as tables for verdicts.py: inputs u…, outputs y….

    studies/focus/package_sets.py FOLDER      # downloads gretl-data, gretl-common and python3-statsmodels, installs nothing

Pairs were chosen by what their descriptions say acts on what, before any was learned from.
"""
import csv
import gzip
import pathlib
import re
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as tree

PACKAGES = ["gretl-data", "gretl-common", "python3-statsmodels"]
GRETL = {  # name: inputs, outputs
    "data10-2": (["temp"], ["load"]),
    "bikesharing": (["temp", "hum", "windspeed"], ["cnt"]),
    "hamilton": (["PZUNEW", "EXRITL"], ["PC6IT"]),
    "sw_ch14": (["LHUR"], ["PUNEW"]),
    "sw_ch12": (["FYFF"], ["FYGM3"]),
    "data9-11": (["sp500"], ["volume"]),
    "data9-12": (["pcdpy", "primert"], ["pcecars"]),
    "data9-13": (["sp500"], ["bkret"]),
    "data10-1": (["M"], ["r"]),
    "gdp_midas": (["ld_payems_m1", "ld_indpro_m1"], ["ld_qgdp"]),
    "AWM18": (["PCR"], ["YER"]),
    "np": (["gnpdefl"], ["nwage"]),
    "hall": (["vwr"], ["consrat"]),
    "greene5_1": (["realdpi"], ["realcons"]),
    "greene18_2": (["M1"], ["P"]),
    "arma": (["eps"], ["y"]),
}
STATSMODELS = {
    "macrodata/macrodata": (["realcons", "tbilrate"], ["realinv"]),
    "copper/copper": (["COPPERPRICE", "INCOMEINDEX"], ["WORLDCONSUMPTION"]),
}


def write(folder, name, inputs, outputs, columns):
    wanted = [columns[one] for one in inputs + outputs]
    names = [f"u{k + 1}" for k in range(len(inputs))] + [f"y{k + 1}" for k in range(len(outputs))]
    with open(folder / f"{name}.csv", "w") as out:
        out.write(",".join(names) + "\n")
        for row in zip(*wanted):
            out.write(",".join(row) + "\n")


def gretl(path):
    data = path.read_bytes()
    data = gzip.decompress(data) if data[:2] == b"\x1f\x8b" else data
    root = tree.fromstring(re.sub(rb"<!DOCTYPE[^>]*>", b"", data))
    names = [one.get("name") for one in root.find("variables")]
    rows = [(one.text or "").split() for one in root.find("observations")]
    return {name: ["" if row[k] == "NA" else row[k] for row in rows] for k, name in enumerate(names)}


def main():
    folder = pathlib.Path(sys.argv[1])
    folder.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as name:
        there = pathlib.Path(name)
        subprocess.run(["apt-get", "download", "-qq", *PACKAGES], cwd=there, check=True)
        for package in there.glob("*.deb"):
            subprocess.run(["dpkg", "-x", str(package), str(there / "all")], check=True)
        for path in sorted((there / "all").rglob("*.gdt")):
            if path.stem in GRETL:
                write(folder, path.stem, *GRETL[path.stem], gretl(path))
        for one, (inputs, outputs) in STATSMODELS.items():
            for path in (there / "all").rglob(f"datasets/{one}.csv"):
                with open(path) as table:
                    rows = list(csv.DictReader(table))
                write(folder, path.stem, inputs, outputs, {key: [row[key] for row in rows] for key in rows[0]})


if __name__ == "__main__":
    main()
