"""Programs and peers as processes, timed from outside."""

import json
import pathlib
import statistics
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent


def run(command, cwd, accept=(0,)):
    """Seconds of one run, start to end, and its standard output. Ends the comparison where it fails."""
    start = time.perf_counter()
    done = subprocess.run([str(word) for word in command], cwd=cwd, capture_output=True, text=True)
    seconds = time.perf_counter() - start
    if done.returncode not in accept:
        sys.exit(f"error: {' '.join(map(str, command))}: exit code {done.returncode}\n{done.stderr.strip()}")
    return seconds, done.stdout


def peer(script, words, cwd):
    """One run of a peer in a Python process of its own: what it reports, and `whole_s`."""
    seconds, output = run([sys.executable, HERE / script, *words], cwd)
    report = json.loads(output.splitlines()[-1])
    report["whole_s"] = seconds
    return report


def median(values):
    return statistics.median(values)


def say(text):
    print(text, file=sys.stderr, flush=True)
