"""Programs and peers as processes, timed from outside."""

import json
import os
import pathlib
import resource
import statistics
import subprocess
import sys
import time

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent


# What helps the peers: threads for sums over 20,000 rows cost more than they save, and temporary arrays of that size
# would be handed back to the kernel and asked for anew all the time.
FAVORS = {
    "OPENBLAS_NUM_THREADS": "1", "MALLOC_MMAP_THRESHOLD_": "1000000000", "MALLOC_TRIM_THRESHOLD_": "1000000000",
}


def processor_s():
    """Processor time of all processes that have ended so far; a busy machine changes it less than it changes time."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def run(command, cwd, accept=(0,), environment=None, says="stdout"):
    """Seconds of one run, start to end, and what it `says`. Ends the comparison where it fails."""
    start = time.perf_counter()
    done = subprocess.run([str(word) for word in command], cwd=cwd, capture_output=True, text=True, env=environment)
    seconds = time.perf_counter() - start
    if done.returncode not in accept:
        sys.exit(f"error: {' '.join(map(str, command))}: exit code {done.returncode}\n{done.stderr.strip()}")
    return seconds, getattr(done, says)


def peer(script, words, cwd):
    """One run of a peer in a Python process of its own: what it reports, and `whole_s`."""
    before = processor_s()
    seconds, output = run([sys.executable, HERE / script, *words], cwd, environment={**os.environ, **FAVORS})
    report = json.loads(output.splitlines()[-1])
    report["whole_s"], report["processor_s"] = seconds, processor_s() - before
    return report


def median(values):
    return statistics.median(values)


def say(text):
    print(text, file=sys.stderr, flush=True)
