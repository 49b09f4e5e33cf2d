#!/usr/bin/env python3
"""Lets each system call of each command that writes fail once, and kills the command after each one.

For a small case of each command it counts the system calls that touch the case's folder (by
call_tracer). Then:

every fault        the command runs again with one call failing: by EIO, or by a disk that is full from
                   this call on. The exit code tells; one line names the cause; the earlier result is
                   whole or the new one is.
every crash state  the command runs again and is killed (SIGKILL) right after one call: the process
                   that made it, and, if this was a child, in further runs the first process alone and
                   all of them. After a write also when half of its bytes are there.

After each of them the same command, undisturbed, gives the bytes of one that was never disturbed, and
leaves nothing beside them. Bytes that differ between undisturbed runs (dates, seconds) do not count.

By default each command gets about 50 disturbances, spread over its calls; --every 1 tries all, which
takes hours.

Exit codes: 0 nothing fell; 1 something did; 2 the cases themselves do not work; 77 cannot run here.
"""
import argparse
import collections
import concurrent.futures
import dataclasses
import gzip
import hashlib
import json
import os
import pathlib
import queue
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time

HERE = pathlib.Path(__file__).resolve().parent
CAUSES = {"EIO": "Input/output error", "full": "No space left on device"}
# Files that a library writes or reads, which does not tell the cause; the message that is accepted.
UNTOLD = {"video.mp4": "did not become whole", ".obj": "MuJoCo refuses", ".png": "MuJoCo refuses"}
# After these calls the folder differs from what it was before them.
CHANGING = {"create", "open", "write", "sendfile", "copy_file_range", "fallocate", "ftruncate",
            "truncate", "rename", "exchange", "link", "symlink", "unlink", "rmdir", "mkdir"}
TAKES_ROOM = {"create", "write", "sendfile", "copy_file_range", "fallocate", "mkdir"}
SCENARIO = """purpose: a box crosses before the rover
scene: lab
seed: 1
frames: {frames}
ego: {{start: [-4 m, 0 m], speed: {speed} m/s}}
camera: {{size: [160, 120]}}
actors:
  box:
    shape: box
    size: [0.5 m, 0.5 m, 0.6 m]
    trajectory:
      line: {{from: [0.5 m, -2 m], heading: 90 deg, speed: 0.5 m/s}}
"""


@dataclasses.dataclass
class Case:
    """A command line on a small case. The earlier result is made by other commands beforehand."""
    name: str
    command: list          # the arguments of lcs
    targets: list          # what the command makes, relative to the case's folder
    before: list = dataclasses.field(default_factory=list)   # commands that make its inputs
    earlier: list = dataclasses.field(default_factory=list)  # commands that make an earlier result
    files: dict = dataclasses.field(default_factory=dict)    # inputs by name
    # A target that grows in place counts as a result when this file is there; "": at once.
    whole_if: str = ""
    never_torn: bool = True  # whether the targets are old or new at each moment, also after a kill
    fine: tuple = (0,)       # exit codes of the undisturbed command


def scenario(frames=3, speed=0.5):
    return SCENARIO.format(frames=frames, speed=speed)


def cases():
    one = {"near.yaml": scenario()}
    two = {"s/far.yaml": scenario(2, 0.4), "s/near.yaml": scenario(2)}
    run = ["run", "near.yaml", "--quiet", "--out", "made"]
    other = ["--set", "ego.speed=0.6 m/s"]
    suite = ["suite", "s", "--seeds", "1", "--jobs", "1", "--quiet", "--out", "made"]
    record = [["run", "near.yaml", "--quiet", "--no-video", "--out", "base"]]
    made = ["made"]
    file = ["made.txt", ".made.txt.lcs-written"]
    generate = ["generate", "near.yaml", "--quiet", "--out", "made", "--formats"]
    worlds = ["suite", "--worlds", "train", "--family", "room", "--count", "1", "--seeds", "1",
              "--jobs", "1", "--set", "frames=2", "--set", "camera.size=[160,120]", "--quiet",
              "--out", "made"]

    def shard(i, out):
        return suite[:-1] + [out, "--shard", f"{i}/2"]

    pictures = [["generate", "near.yaml", "--quiet", "--out", "drive", "--formats", "euroc"]]
    replayed = ["replay", "drive", "--quiet"]
    yield Case("run", run, made, files=one, earlier=[run + other])
    yield Case("run --beside", run + ["--no-video", "--beside", "klt=beside"],
               made + ["beside"], files=one, never_torn=False,
               earlier=[run + other + ["--no-video", "--beside", "klt=beside"]])
    yield Case("run --recorded", run + ["--no-video", "--recorded", "base"], made,
               files=one, before=record, earlier=[run + other])
    yield Case("suite", suite, made, files=two, earlier=[suite + other])
    yield Case("suite --beside", suite + ["--beside", "klt"], made, files={"s/n.yaml": scenario(2)},
               earlier=[suite + other])
    yield Case("suite --keep figures", suite + ["--keep", "figures"], made, files=two,
               earlier=[suite + other])
    yield Case("suite --recorded", suite + ["--recorded", "base"], made, files=two,
               before=[suite[:-1] + ["base"]], earlier=[suite + other])
    yield Case("suite --shard", shard(1, "made"), made, files=two, earlier=[suite + other])
    yield Case("suite --worlds", worlds, made, earlier=[worlds + other])
    yield Case("merge", ["merge", "p1", "p2", "--quiet", "--out", "made"], made, files=two,
               before=[shard(1, "p1"), shard(2, "p2")], earlier=[suite + other])
    yield Case("generate", generate + ["euroc"], made, files=one, whole_if="manifest.json",
               never_torn=False)
    yield Case("generate all but bags", generate + ["coco,kitti,landmarks,flow,depth,tum"], made,
               files=one, whole_if="manifest.json", never_torn=False)
    yield Case("generate after a part", generate + ["euroc"], made, files=one,
               before=[generate + ["euroc", "--shard", "1/2"]], whole_if="manifest.json",
               never_torn=False)
    for more in ["coco", "dsec", "mcap", "rrd"]:
        yield Case(f"generate --add {more}", generate + [more, "--add"], made, files=one,
                   whole_if="manifest.json", earlier=[generate + ["euroc"]], never_torn=False)
    yield Case("tune", ["tune", "train", "--keys", "hypotheses.prior", "--evaluations", "3",
                        "--quiet", "--out", "made"], made, whole_if="record.md", never_torn=False,
               before=[worlds[:-1] + ["train"]])
    yield Case("score --out", ["score", "base", "--quiet", "--out", "made.txt"], file,
               files={**one, "none.csv": ""}, before=record, never_torn=False,
               earlier=[["score", "base", "--quiet", "--out", "made.txt", "--detections",
                         "none.csv"]])
    yield Case("score --write-detections",
               ["score", "base", "--quiet", "--write-detections", "made.txt"], file, files=one,
               before=record, never_torn=False)
    yield Case("explain --picture",
               ["explain", "base", "0", "--track", "1", "--picture", "made.txt"], file, files=one,
               before=record, never_torn=False)
    yield Case("replay", replayed + ["--out", "made"], made, files=one, before=pictures,
               earlier=[replayed + ["--out", "made", "--set", "hypotheses.prior=0.1"]])
    yield Case("replay --write", replayed[:-1] + ["--write", "made.txt"], file, files=one,
               before=pictures, never_torn=False,
               earlier=[replayed[:-1] + ["--write", "made.txt", "--set", "hypotheses.prior=0.1"]])
    yield Case("preview", ["preview", "near.yaml", "--quiet", "--out", "made.txt", "--mjcf",
                           "made.xml"], file + ["made.xml", ".made.xml.lcs-written"], files=one,
               never_torn=False, fine=(0, 1),
               earlier=[["preview", "near.yaml", "--quiet", "--out", "made.txt", "--mjcf",
                         "made.xml"] + other])
    world = ["world", "room", "--quiet", "--out", "made"]
    yield Case("world", world, made, earlier=[world + ["--seed", "2"]])
    compare = ["compare", "a", "b", "--markdown", "made"]
    yield Case("compare --markdown", compare, made, files=two,
               before=[suite[:-1] + ["a"], suite[:-1] + ["b"] + other], fine=(0, 1),
               earlier=[["compare", "a", "a", "--markdown", "made"]])


# What a folder holds.

def is_record(path):
    return path.name.endswith(".lcs-written")


def is_temporary(name):
    """Whether it is a file for going on, which the next command takes away."""
    return ".partial-" in name or ".unfinished" in name


def sha256(data):
    return hashlib.sha256(data).hexdigest()


def text_of_record(path, data):
    """The lines of a record of written files, with a verdict in place of each digest."""
    lines = []
    for line in data.decode(errors="replace").splitlines():
        digest, _, name = line.partition("  ")
        file = path.parent / name
        right = file.is_file() and sha256(file.read_bytes()) == digest
        lines.append(f"{'right' if right else 'WRONG'} {name}")
    return "\n".join(lines)


def flattened(value, key=""):
    """The values of a JSON document, by keys in which each place of a list is a '*'."""
    if isinstance(value, dict):
        for name, inner in value.items():
            yield from flattened(inner, f"{key}.{name}")
        yield f"{key}{{}}", sorted(value)
    elif isinstance(value, list):
        for inner in value:
            yield from flattened(inner, f"{key}[]")
        yield f"{key}[]#", len(value)
    else:
        yield key, value


FAILED_RUNS = "a result with failed runs"
# A finished piece of work, as the commands that go on keep it.
FINISHED = re.compile(r" -> (\S+\.unfinished/(?:(?:in|work)/(?:beside/\w+/)?runs/[^/ ]+/seed-\d+|"
                      r"in/mav0/cam0/data/(?!10{18}\.)\d+\.png))$")  # a second frame
MOMENT = re.compile(r"\d{4}-\d\d-\d\d[T ]\d\d:\d\d(?::\d\d)?(?:\.\d+)?Z?")
MILLISECONDS = re.compile(r"\| [\d.-]+ \| [\d.-]+ \|$", re.M)  # the last columns of standing.md
TOKEN = re.compile(r"\d+(?:\.\d+)?(?:[eE][-+]?\d+)?|[A-Za-z_]+|\s+|.", re.S)


def parts_of(path, data):
    """A file as a list of (place, value), so that places which differ by chance can be named."""
    if is_record(path):
        return [("record", text_of_record(path, data))]
    if data[:2] == b"\x1f\x8b":
        try:
            data = gzip.decompress(data)
        except (OSError, EOFError):
            return [("broken gzip", sha256(data))]
    try:
        text = MILLISECONDS.sub("| MS | MS |", MOMENT.sub("MOMENT", data.decode()))
    except UnicodeDecodeError:
        return [("bytes", sha256(data))]
    if path.suffix in (".json", ".gz", ".jsonl"):
        try:
            return [part for line in ([text] if path.suffix == ".json" else text.splitlines())
                    for part in flattened(json.loads(line))]
        except ValueError:
            pass
    tokens = TOKEN.findall(text)
    return [(str(place), token) for place, token in enumerate(tokens)] + [("end", len(tokens))]


def contents(folder):
    """The bytes of all files below a folder; None for a folder."""
    found = {}
    for path in sorted(folder.rglob("*")):
        name = str(path.relative_to(folder))
        if path.is_symlink():
            found[name] = b"-> " + os.fsencode(os.readlink(path))
        elif path.is_dir():
            found[name] = None
        else:
            found[name] = path.read_bytes()
    return found


class Reference:
    """What an undisturbed command leaves, as several runs have it."""

    def __init__(self):
        self.files = None    # the bytes of the first run
        self.parts = {}      # of files that differ between the runs
        self.chance = {}     # the places where they differ; None: the whole file

    def add(self, folder):
        now = contents(folder)
        if self.files is None:
            self.files = now
            self.parts = {name: parts_of(folder / name, data)
                          for name, data in now.items() if data is not None}
            return
        if set(now) != set(self.files):
            differing = sorted(set(now) ^ set(self.files))
            raise CannotWork(f"two undisturbed runs leave different files: {differing[:5]}")
        for name, data in now.items():
            if data == self.files[name] or data is None:
                continue
            parts = parts_of(folder / name, data)
            known = self.parts[name]
            if self.chance.get(name, ()) is None:
                continue
            if [place for place, _ in parts] != [place for place, _ in known]:
                self.chance[name] = None
                continue
            places = self.chance.setdefault(name, set())
            places.update(place for (place, old), (_, new) in zip(known, parts) if old != new)

    def fault(self, folder, within=None):
        """How a folder differs from the reference; "" if it does not. `within`: only these paths,
        in which temporary files may be left."""
        def asked(name):
            return within is None or any(name == one or name.startswith(one + "/")
                                         for one in within)
        now = {name: data for name, data in contents(folder).items() if asked(name)}
        files = {name: data for name, data in self.files.items() if asked(name)}
        for name in sorted(set(now) ^ set(files)):
            if within is not None and name in now and is_temporary(name):
                continue
            return f"{name} is left over" if name in now else f"{name} is missing"
        for name, data in now.items():
            if name not in files:
                continue
            if data == files[name]:
                if data is None or not is_record(folder / name):
                    continue
            if (data is None) != (files[name] is None):
                return f"{name} is a file here and a folder there"
            chance = self.chance.get(name, set())
            if chance is None:
                continue
            parts = parts_of(folder / name, data)
            known = self.parts[name]
            if [place for place, _ in parts] != [place for place, _ in known]:
                return f"{name} has {len(data)} bytes of another form in place of {len(files[name])}"
            for (place, new), (_, old) in zip(parts, known):
                if new != old and place not in chance:
                    return f"{name}: {str(new)[:60]!r} in place of {str(old)[:60]!r} at {place}"
        return ""


class CannotWork(Exception):
    """The case itself does not work, so that nothing can be said about the program."""


# One command, disturbed and repeated.

@dataclasses.dataclass
class Call:
    """A call as call_tracer names it."""
    kind: str
    path: str
    number: int
    is_first: bool  # of the first process
    result: int

    @property
    def target(self):
        return f"{self.kind}\t{self.path} {self.number}"

    def __str__(self):
        number = f" ({self.number})" if self.number > 1 else ""
        by = "" if self.is_first else ", by a child"
        return f"{self.kind} {self.path}{number}{by}"


@dataclasses.dataclass
class End:
    code: int
    err: str


class Bench:
    """Runs the cases, all at one place, so that paths in results are equal."""

    def __init__(self, options, home):
        self.options = options
        self.home = home
        self.here = home / "case"
        self.list = home / "calls"
        self.environment = dict(os.environ, TMPDIR=str(self.here / "tmp"), LC_ALL="C.UTF-8",
                                PYTHONDONTWRITEBYTECODE="1")

    def start(self, words):
        with open(self.home / "err", "w+b") as err, open(self.home / "out", "w+b") as out:
            child = subprocess.Popen(words, cwd=self.here, env=self.environment, stdout=out,
                                     stderr=err, stdin=subprocess.DEVNULL, start_new_session=True)
            try:
                code = child.wait(timeout=self.options.timeout)
            except subprocess.TimeoutExpired:
                os.killpg(child.pid, signal.SIGKILL)
                child.wait()
                code = -999
            err.seek(0)
            return End(code, err.read().decode(errors="replace"))

    def lcs(self, arguments):
        return self.start([self.options.lcs, *arguments])

    def traced(self, arguments, target="", action=""):
        end = self.start([self.options.tracer, str(self.here), str(self.list), target, action,
                          self.options.lcs, *arguments])
        calls, is_reached = [], False
        for line in self.list.read_text(errors="replace").splitlines():
            kind, rest, first, result, changed = line.split("\t")
            path, _, number = rest.rpartition(" ")
            calls.append(Call(kind, path, int(number), first == "1", int(result)))
            is_reached |= changed == "changed"
        return end, calls, is_reached

    def restore(self, template):
        shutil.rmtree(self.here, ignore_errors=True)
        shutil.copytree(template, self.here, symlinks=True)

    def prepare(self, case, with_earlier):
        """Makes the template of a case: its inputs and, if asked, an earlier result."""
        template = self.home / "template"
        shutil.rmtree(template, ignore_errors=True)
        shutil.rmtree(self.here, ignore_errors=True)
        (self.here / "tmp").mkdir(parents=True)
        for name, text in case.files.items():
            (self.here / name).parent.mkdir(parents=True, exist_ok=True)
            (self.here / name).write_text(text)
        for arguments in case.before + (case.earlier if with_earlier else []):
            end = self.lcs(arguments)
            if end.code not in (0, 1):
                raise CannotWork(f"lcs {' '.join(arguments)}: exit code {end.code}: {end.err}")
        shutil.copytree(self.here, template, symlinks=True)
        return template


def said(err):
    """The lines of an error output; a line that was drawn over by the next one does not count."""
    return [line.rsplit("\r", 1)[-1].strip() for line in err.splitlines() if line.strip()]


def without_numbers(line):
    return re.sub(r"\d+", "0", line)


class Trial:
    """One case in one variant: with or without an earlier result."""

    def __init__(self, bench, case, with_earlier):
        self.bench, self.case = bench, case
        self.label = case.name + (" (over an earlier one)" if with_earlier else "")
        self.template = bench.prepare(case, with_earlier)
        self.reference = Reference()
        self.calls = []
        for i in range(5):  # rounded seconds are often equal by chance
            bench.restore(self.template)
            end = bench.lcs(case.command) if i else self.first()
            if end.code not in case.fine:
                raise CannotWork(f"lcs {' '.join(case.command)}: exit code {end.code}: {end.err}")
            if case.name.startswith(("suite", "generate")) and \
                    not any(FINISHED.search(call.path) for call in self.calls):
                raise CannotWork("no finished run or frame is seen; see FINISHED")
            self.reference.add(bench.here)
            self.usual = {without_numbers(line) for line in said(end.err)}
        self.old = {name: data for name, data in contents(self.template).items()
                    if self.is_target(name)}
        self.code = end.code

    def first(self):
        end, self.calls, _ = self.bench.traced(self.case.command)
        return end

    def is_target(self, name):
        return any(name == one or name.startswith(one + "/") for one in self.case.targets)

    def state(self):
        """"old", "new", "growing", or how the targets differ from all of these."""
        now = {name: data for name, data in contents(self.bench.here).items()
               if self.is_target(name)}
        if now == self.old:
            return "old"
        fault = self.reference.fault(self.bench.here, self.case.targets)
        if not fault:
            return "new"
        if self.case.whole_if:
            mark = f"{self.case.targets[0]}/{self.case.whole_if}"
            if now.get(mark) == self.old.get(mark):
                lost = [name for name, data in self.old.items()
                        if now.get(name) != data and not name.endswith("README.md")]
                return f"{lost[0]} of the earlier result was changed" if lost else "growing"
        return FAILED_RUNS if self.tells_failed_runs() else fault

    def tells_failed_runs(self):
        """Whether the target is a whole suite that tells of runs which failed."""
        folder = self.bench.here / self.case.targets[0]
        try:
            record = text_of_record(folder / ".lcs-written", (folder / ".lcs-written").read_bytes())
            scenarios = json.loads((folder / "suite.json").read_text())["scenarios"]
        except (OSError, ValueError, KeyError):
            return False
        return "WRONG" not in record and any(
            run["outcome"] == "error" for one in scenarios for run in one["runs"])

    def is_gone(self, name):
        """Whether a finished file exists no more, not even in the sequence to which --add adds, whose
        files are those of the unfinished one, too."""
        shared = name.replace(".unfinished/in/", "/") if "--add" in self.case.command else name
        return not any((self.bench.here / one).exists() for one in (name, shared))

    def lost_work(self, calls):
        """A piece of work that was finished and is gone, or ""."""
        for call in calls:
            found = FINISHED.search(call.path)
            if found and call.result == 0 and self.is_gone(found[1]):
                return f"work is lost: {found[1]} was finished, and is gone"
        for name in contents(self.template):  # of an earlier process
            if ".unfinished/in/" in name and self.is_gone(name):
                return f"work is lost: {name} was there before, and is gone"
        return ""

    def repeat(self):
        """Runs the undisturbed command. Returns what is wrong then, or ""."""
        end = self.bench.lcs(self.case.command)
        if end.code not in self.case.fine:
            return f"the same command then ends with {end.code}: {' | '.join(said(end.err))[:300]}"
        fault = self.reference.fault(self.bench.here)
        return f"after the same command: {fault}" if fault else ""

    def words(self, end):
        """What is wrong with the error output of a command that failed, or ""."""
        lines = [line for line in said(end.err) if without_numbers(line) not in self.usual]
        text = " | ".join(lines)[:400]
        if end.code == -999:
            return "it does not end"
        if end.code < 0 or end.code > 130:
            return f"it crashes with {end.code}: {text}"
        if not lines:
            return f"exit code {end.code} without a word"
        if re.search(r"Traceback|terminate called|Assertion|Aborted", end.err):
            return f"a stack trace: {text}"
        if sum(line.startswith("lcs: ") for line in lines) > 1:
            return f"more than one line: {text}"
        return ""

    def disturbed(self, call, action):
        """How the command ends, the state and [lost work]; None if the call was not reached."""
        self.bench.restore(self.template)
        end, calls, is_reached = self.bench.traced(self.case.command, call.target, action)
        if not is_reached:
            return None
        state = self.state()
        may_lose = state in ("new", FAILED_RUNS) or end.code in self.case.fine
        return end, state, [] if may_lose else [self.lost_work(calls)]

    def fault(self, call, action):
        """Lets one call fail. Returns what is wrong, or ""; None if the call was not reached."""
        disturbed = self.disturbed(call, action)
        if not disturbed:
            return None
        end, state, wrong = disturbed
        if end.code in self.case.fine:
            if state != "new":
                wrong.append(f"exit code {end.code}, but {state}")
        else:
            wrong.append(self.words(end))
            is_named = any(untold in end.err for file, untold in UNTOLD.items()
                           if call.path.endswith(file))
            if CAUSES[action] not in end.err and not is_named:
                wrong.append(f"the cause ({CAUSES[action]}) is not named: "
                             f"{' | '.join(said(end.err))[:300]}")
            place = call.path.split("/")[0].split(".partial-")[0]
            if (str(self.bench.here) if place == "." else place) not in end.err:
                wrong.append(f"{place} is not named: {' | '.join(said(end.err))[:300]}")
            if state not in ("old", "new", "growing"):
                wrong.append(f"neither old nor new: {state}")
        wrong.append(self.repeat())
        return " || ".join(filter(None, wrong))

    def crash(self, call, action):
        """Kills after one call. Returns what is wrong, or ""; None if the call was not reached."""
        disturbed = self.disturbed(call, action)
        if not disturbed:
            return None
        end, state, wrong = disturbed
        is_told = state == FAILED_RUNS and not call.is_first and \
            action in ("kill", "kill-torn")
        if self.case.never_torn and not is_told and state not in ("old", "new", "growing"):
            wrong.append(f"neither old nor new: {state}")
        if action in ("kill", "kill-torn") and not call.is_first:
            if end.code in self.case.fine and state != "new":
                wrong.append(f"a child was killed, and exit code {end.code}, but {state}")
            if end.code not in self.case.fine:
                wrong.append(self.words(end))
        elif end.code == -999:
            wrong.append("it does not end")
        wrong.append(self.repeat())
        return " || ".join(filter(None, wrong))


def plan_of(calls):
    """All disturbances of these calls: ("fault" or "crash", call, action)."""
    # Files that are looked for in vain, and the end of reading, tell nothing about results.
    calls = [call for call in calls if call.kind != "close-read" and
             not (call.kind == "open-read" and call.result < 0)]
    for call in calls:
        yield "fault", call, "EIO"
        if call.kind in TAKES_ROOM:
            yield "fault", call, "full"
    for call in calls:
        if call.kind not in CHANGING or call.result < 0:
            continue
        yield "crash", call, "kill"
        if call.kind == "write":
            yield "crash", call, "kill-torn"
        if not call.is_first:
            yield "crash", call, "kill-all"
            yield "crash", call, "kill-first"


def spread(plan, every, most):
    """Chooses every n-th of the faults of reading, of the other faults, and of the crash states, so
    that there are about `most` of all. Returns the three n, and what is chosen."""
    def group(one):
        return 2 if one[0] == "crash" else int(one[1].kind != "open-read")
    steps, chosen = [], []
    for i, share in enumerate([-(-most // 5), most * 2 // 5, most * 2 // 5]):
        mine = [one for one in plan if group(one) == i]
        if not mine or not (every or share):
            steps.append("-")
            continue
        n = every or -(-len(mine) // share)
        if n % 2 == 0 and not every:
            n += 1  # odd, as the kinds of disturbances of a call alternate
        steps.append(n)
        chosen += mine[n // 2::n]
    return "/".join(map(str, steps)), chosen


@dataclasses.dataclass
class Row:
    label: str
    calls: int = 0
    every: str = ""
    faults: int = 0
    crashes: int = 0
    missed: int = 0
    seconds: float = 0
    fell: list = dataclasses.field(default_factory=list)


def try_all(bench, case, with_earlier):
    start = time.monotonic()
    trial = Trial(bench, case, with_earlier)
    row = Row(trial.label)
    whole = [f"{name} ({'whole' if places is None else len(places)})"
             for name, places in trial.reference.chance.items()]
    plan = list(plan_of(trial.calls))
    row.calls = len({call.target for _, call, _ in plan})
    note(f"{row.label}: {row.calls} calls, {len(plan)} disturbances; differ by chance: "
         f"{', '.join(whole) or 'nothing'}")
    row.every, plan = spread(plan, bench.options.every, bench.options.most)
    for kind, call, action in plan:
        if bench.options.call and bench.options.call not in str(call):
            continue
        fault = trial.fault(call, action) if kind == "fault" else trial.crash(call, action)
        if fault is None:
            row.missed += 1
            continue
        if kind == "fault":
            row.faults += 1
        else:
            row.crashes += 1
        if fault:
            row.fell.append((action, str(call), fault))
            note(f"{row.label}: FELL {action} at {call}: {fault}")
    row.seconds = time.monotonic() - start
    note(f"{row.label}: {row.faults} faults, {row.crashes} crash states (every {row.every}.), "
         f"{len(row.fell)} fell, {row.missed} not reached, {row.seconds:.0f} s")
    return row


def cause_of(fault):
    """A fault without what is special to its call, so that equal ones can be counted."""
    fault = re.sub(r"warning: [^|]* \| ", "", fault).replace("Input/output", "Input-output")
    fault = re.sub(r"[\w./-]*(?:/|\.(?:partial-|unfinished|json|csv|mp4|mcap|png|jpg|yaml|txt|xml|html|"
                   r"gz|obj|mjpeg|md|lcs-written))[\w./-]*", "PATH", fault)
    fault = re.sub(r"PATH: PATH\b", "PATH", fault)
    return re.sub(r"\w+ seed \d+|\d{2,}|'[^']*'", "N", fault)[:160]


def causes(rows):
    """Lists what fell, equal ones together, each with one example."""
    groups = collections.defaultdict(list)
    for row in rows:
        for action, call, fault in row.fell:
            for part in fault.split(" || "):
                groups[cause_of(part)].append((row.label, action, call, part))
    for cause, all_of_it in sorted(groups.items(), key=lambda item: -len(item[1])):
        label, action, call, fault = all_of_it[0]
        note(f"\n{len(all_of_it)} times: {cause}\n  as {label}: {action} at {call}\n  {fault}")


def note(text):
    print(text, flush=True)


def table(rows):
    note(f"\n{'command':42} {'calls':>6} {'every':>8} {'faults':>6} {'crashes':>7} {'missed':>6} "
         f"{'s':>5} {'fell':>5}")
    for row in rows:
        note(f"{row.label:42} {row.calls:6} {row.every:>8} {row.faults:6} {row.crashes:7} "
             f"{row.missed:6} {row.seconds:5.0f} {len(row.fell):5}")
    note(f"{'all':42} {sum(r.calls for r in rows):6} {'':8} {sum(r.faults for r in rows):6} "
         f"{sum(r.crashes for r in rows):7} {sum(r.missed for r in rows):6} "
         f"{sum(r.seconds for r in rows):5.0f} {sum(len(r.fell) for r in rows):5}")


def is_able(case, python):
    needed = {"generate --add mcap": "rosbags", "generate --add dsec": "h5py",
              "generate --add rrd": "rerun"}.get(case.name)
    return not needed or subprocess.run([python, "-c", f"import {needed}"], check=False,
                                        stderr=subprocess.DEVNULL).returncode == 0


def tracer_of(options, home):
    """Compiles call_tracer, unless it is given."""
    if options.tracer:
        return str(pathlib.Path(options.tracer).resolve())
    program = home / "call_tracer"
    subprocess.run(["c++", "-std=c++20", "-O1", "-o", program, HERE / "call_tracer.cpp"], check=True)
    return str(program)


def main():
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n", 1)[0])
    parser.add_argument("--lcs", required=True, help="the program")
    parser.add_argument("--tracer", help="call_tracer; compiled if not given")
    parser.add_argument("--only", action="append", default=[], metavar="COMMAND",
                        help="only this case; as 'suite' or 'merge', may be repeated")
    parser.add_argument("--call", help="only calls with this text in their description")
    parser.add_argument("--every", type=int, default=0, metavar="N",
                        help="every N-th disturbance, 1 for all; chosen by --most if not given")
    parser.add_argument("--most", type=int, default=50, metavar="N",
                        help="about N disturbances of a command; %(default)s if not given")
    parser.add_argument("--jobs", type=int, default=os.cpu_count(), metavar="N",
                        help="commands at a time; one on each core if not given")
    parser.add_argument("--timeout", type=float, default=120, metavar="SECONDS",
                        help="when a command counts as hanging")
    parser.add_argument("--work", metavar="DIR", help="folder for the cases; a temporary one")
    parser.add_argument("--keep", action="store_true", help="keep the folder of the cases")
    parser.add_argument("--list", action="store_true", help="only list the cases")
    options = parser.parse_args()
    chosen = [case for case in cases() if not options.only or case.name in options.only]
    if options.list:
        print("\n".join(case.name for case in chosen))
        return 0
    if not chosen:
        parser.error("there is no such case; see --list")
    options.lcs = str(pathlib.Path(options.lcs).resolve())
    if options.work:
        os.makedirs(options.work, exist_ok=True)
    home = pathlib.Path(tempfile.mkdtemp(prefix="every_fault_", dir=options.work)).resolve()
    rows, failed = [], []
    benches = queue.SimpleQueue()  # those at which nobody works

    def work(case, with_earlier):
        bench = benches.get()
        try:
            rows.append(try_all(bench, case, with_earlier))
        except CannotWork as error:
            note(f"{case.name} does not work: {error}")
            failed.append(case.name)
        finally:
            benches.put(bench)

    try:
        options.tracer = tracer_of(options, home)
        if subprocess.run([options.tracer, str(home), str(home / "calls"), "", "", "true"],
                          check=False).returncode != 0:
            note("SKIPPED: no process can be traced here (ptrace, seccomp)")
            return 77
        for number in range(options.jobs):
            place = home / str(number)
            place.mkdir()
            benches.put(Bench(options, place))
        python = os.environ.get("LCS_PYTHON", "python3")
        with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
            works = []
            for case in chosen:
                if not is_able(case, python):
                    note(f"{case.name}: left out, as {python} lacks its library")
                    continue
                for with_earlier in variants(case):
                    works.append(pool.submit(work, case, with_earlier))
            for one in works:
                one.result()
    finally:
        if rows:
            causes(rows)
            table(rows)
        if options.keep:
            note(f"the cases are in {home}")
        else:
            shutil.rmtree(home, ignore_errors=True)
    return 2 if failed else int(any(row.fell for row in rows))


def variants(case):
    """Whether there is an earlier result: in one run of the case, and in another."""
    if not case.earlier:
        return [False]
    return [True] if "--add" in case.command else [False, True]


if __name__ == "__main__":
    sys.exit(main())
