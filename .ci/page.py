#!/usr/bin/env python3
"""Runs every command of a page of the documentation and compares what it prints.

usage: page.py PAGE STEPWAVE FOLDER

A block of the page that begins with `stepwave …` holds a command and what it prints; a block after a line with the name of
a file in bold holds that file. Lines of a block that are not printed are a mistake.
"""
import pathlib
import re
import shlex
import subprocess
import sys

page, stepwave, folder = pathlib.Path(sys.argv[1]), str(pathlib.Path(sys.argv[2]).resolve()), pathlib.Path(sys.argv[3])
folder.mkdir(parents=True, exist_ok=True)
text = page.read_text()
commands = 0
for name, block in re.findall(r"(?:\*\*`([\w.]+)`\*\*[^\n]*\n\n)?```\w*\n(.*?)```\n", text, flags=re.S):
    if name:
        (folder / name).write_text(block)
    elif block.startswith("stepwave "):
        command, _, printed = block.partition("\n")
        words = [stepwave, *shlex.split(command)[1:]]
        done = subprocess.run(words, cwd=folder, capture_output=True, text=True)
        shown = done.stdout + done.stderr
        if printed.strip() != shown.strip():
            sys.exit(f"{page}: {command}\nprints\n{shown}\nwhere the page has\n{printed}")
        commands += 1
if commands < 5:
    sys.exit(f"{page}: {commands} commands; there should be five at least")
print(f"{page}: {commands} commands print what the page shows")
