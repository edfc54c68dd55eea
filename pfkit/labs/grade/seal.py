"""Limits that a submission's process puts on itself, before it runs any answer.

=================  =====================================  =======  =====  =======
limit              means                                  Linux    macOS  Windows
=================  =====================================  =======  =====  =======
memory             RLIMIT_AS                              yes      no     no
size of a file     RLIMIT_FSIZE                           yes      yes    no
processor time     RLIMIT_CPU                             yes      yes    no
processes          RLIMIT_NPROC (not for root)            yes      yes    no
core dumps         RLIMIT_CORE                            yes      yes    no
writing elsewhere  Landlock, in the kernel                >= 5.13  no     no
TCP, signals       Landlock                               >= 6.7,  no     no
                                                          6.12
... from Python    audit hook: files, signals, network    yes      yes    yes
=================  =====================================  =======  =====  =======

The audit hook stops accidents and the curious. Whoever can call the C library gets round it, and
then only the kernel's limits hold.
"""

import contextlib
import ctypes
import os
import platform
import sys
from collections.abc import Callable, Mapping
from pathlib import Path
from types import FunctionType, ModuleType
from typing import Any

FILE_SIZE = 100_000_000  # bytes
PROCESSES = 64  # more than the user has already


def limit_resources(memory: int, seconds: float) -> None:
    """Set what the platform can limit: address space in bytes, processor time in seconds."""
    try:
        import resource
    except ImportError:  # Windows
        return
    wanted = {
        "RLIMIT_AS": memory,
        "RLIMIT_FSIZE": FILE_SIZE,
        "RLIMIT_CPU": int(seconds) + 5,
        "RLIMIT_CORE": 0,
        "RLIMIT_NPROC": _processes() + PROCESSES,
    }
    for name, value in wanted.items():
        with contextlib.suppress(ValueError, OSError):  # macOS refuses RLIMIT_AS
            which = getattr(resource, name)
            most = resource.getrlimit(which)[1]
            value = value if most == resource.RLIM_INFINITY else min(value, most)
            resource.setrlimit(which, (value, value))


def _processes() -> int:
    """How many threads this user runs now; RLIMIT_NPROC counts all of them."""
    mine, count = os.getuid(), 0
    for entry in Path("/proc").glob("[0-9]*"):
        with contextlib.suppress(OSError):
            if entry.stat().st_uid == mine:
                count += len(os.listdir(entry / "task"))
    return count or 1_000


# -- what the kernel can refuse ------------------------------------------------------------------

WRITE_FILE, CHANGE_FOLDERS, REFER, TRUNCATE = 1 << 1, 0b1_1111_1111 << 4, 1 << 13, 1 << 14
TCP, SIGNALS = 0b11, 0b10
CREATE, ADD, RESTRICT, NO_NEW_PRIVILEGES = 444, 445, 446, 38  # system calls; an option of prctl


def confine(folders: list[str]) -> int:
    """Let this process and its children write below ``folders`` only (Landlock).

    Returns the kernel's Landlock version, 0 where there is none. From version 4 TCP is refused,
    from version 6 signals to processes other than its own children.
    """
    if sys.platform != "linux" or platform.machine() not in ("x86_64", "aarch64", "riscv64"):
        return 0
    libc = ctypes.CDLL(None, use_errno=True)
    version = libc.syscall(CREATE, None, 0, 1)
    if version < 1:
        return 0
    rights = WRITE_FILE | CHANGE_FOLDERS
    rights |= (REFER if version >= 2 else 0) | (TRUNCATE if version >= 3 else 0)
    refused = [rights, *([TCP] if version >= 4 else []), *([SIGNALS] if version >= 6 else [])]
    table = b"".join(x.to_bytes(8, sys.byteorder) for x in refused)
    ruleset = libc.syscall(CREATE, table, len(table), 0)
    for folder in folders:
        opened = os.open(folder, os.O_PATH | os.O_CLOEXEC)
        allowed = rights if os.path.isdir(folder) else rights & (WRITE_FILE | TRUNCATE)
        rule = allowed.to_bytes(8, sys.byteorder) + opened.to_bytes(4, sys.byteorder)
        libc.syscall(ADD, ruleset, 1, rule, 0)
        os.close(opened)
    libc.prctl(NO_NEW_PRIVILEGES, 1, 0, 0, 0)
    done = libc.syscall(RESTRICT, ruleset, 0) == 0
    os.close(ruleset)
    return version if done else 0


# -- what Python itself can refuse ---------------------------------------------------------------

CHANGES = {
    "os.chmod", "os.chown", "os.link", "os.mkdir", "os.remove", "os.rename", "os.rmdir",
    "os.symlink", "os.truncate", "os.utime", "shutil.rmtree", "shutil.move",
}  # fmt: skip
PROGRAMS = ("os.exec", "os.posix_spawn", "os.system", "subprocess.Popen")
NETWORK = ("socket.connect", "socket.bind", "socket.sendto", "socket.getaddrinfo")
WRITING = os.O_WRONLY | os.O_RDWR | os.O_CREAT | os.O_TRUNC | os.O_APPEND


def watch(folder: str, tell: Callable[[str], None]) -> None:
    """Refuse writes outside ``folder``, signals to others and the network; tell what was tried.

    Programs that an answer starts are told, not refused. An audit hook cannot be removed.
    """
    inside = os.path.realpath(folder)
    realpath, getpid, fspath, fsdecode = os.path.realpath, os.getpid, os.fspath, os.fsdecode

    def hook(event: str, args: tuple[Any, ...]) -> None:
        if event == "open":
            writes = isinstance(args[2], int) and args[2] & WRITING
            paths = [args[0]] if writes and not isinstance(args[0], int) else []
        elif event in CHANGES:
            paths = [a for a in args[:2] if isinstance(a, str | bytes | os.PathLike)]
        elif event in ("os.kill", "os.killpg"):
            if args[0] != getpid():
                refuse(f"sends signal {args[1]} to process {args[0]}")
            return
        elif event in NETWORK:
            refuse("uses the network")
            return
        elif event in PROGRAMS:
            tell("starts a program")  # what it writes is for the kernel to refuse
            return
        else:
            return
        for path in paths:
            real = realpath(fsdecode(fspath(path)))
            if real != inside and not real.startswith(inside + os.sep) and real != os.devnull:
                refuse(f"changes {real}")

    def refuse(what: str) -> None:
        tell(what)
        raise PermissionError(f"the grader does not let an answer do this: it {what}")

    sys.addaudithook(hook)


# -- is the checker still what it was? -----------------------------------------------------------

WATCHED = ("numpy", "builtins", "math", "inspect", "signal", "linecache")


class Unchanged:
    """What the checker consists of now, to compare with later.

    Names of modules and classes, code of functions, fields of items: some ten thousand
    identities, compared in about a millisecond. New names do not matter.
    """

    def __init__(self, lab: Any) -> None:
        self._kept: list[tuple[str, Mapping[str, Any], str, Any]] = []
        self._code: list[tuple[str, FunctionType, Any, Any]] = []
        for name, module in list(sys.modules.items()):
            ours = name.split(".")[0] == "pfkit"
            if isinstance(module, ModuleType) and (ours or name in WATCHED):
                self._keep(name, vars(module))
        for item in lab.items.values():
            self._keep(f"item {item.id}", vars(item))
        self._keep("the items", lab.items)
        self._keep("the lab", {"items": lab.items, "questions": lab.questions}, vars(lab))

    def _keep(self, where: str, names: Mapping[str, Any], real: Any = None) -> None:
        for key, value in list(names.items()):
            if key.startswith("_") and key != "__getattr__" and where in ("builtins", "numpy"):
                continue
            self._kept.append((where, real or names, key, value))
            self._keep_code(f"{where}.{key}", value)
            ours = isinstance(value, type) and value.__module__.startswith("pfkit")
            if ours and value.__module__ == where:
                self._keep(f"{where}.{key}", vars(value))

    def _keep_code(self, name: str, value: Any) -> None:
        value = getattr(value, "fget", None) or getattr(value, "__func__", value)
        if isinstance(value, FunctionType):
            self._code.append((name, value, value.__code__, value.__defaults__))

    def changes(self) -> list[str]:
        """Names that are gone or mean something else now."""
        gone = object()
        found = [
            f"{w}.{key}" for w, names, key, was in self._kept if names.get(key, gone) is not was
        ]
        return found + [
            f"the code of {name}"
            for name, function, code, defaults in self._code
            if function.__code__ is not code or function.__defaults__ is not defaults
        ]
