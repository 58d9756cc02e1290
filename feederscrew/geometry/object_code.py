"""Compiled entries kept as object code: called in a later run without numba, which takes 0.3 s to load.

What numba compiled is written as one object file with a single function, which reads every argument from a
row of 8-byte words. A file that fits neither the sources, the libraries, the processor nor the types of the
arguments is not read, and numba does the work.
"""

import ctypes
import functools
import hashlib
import os
import re
import struct
import sys
import tempfile
import threading
from collections.abc import Callable, Sequence
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import numpy as np

TRIED_ON = ("linux",)  # systems on which object code is kept
THUNK = "entry_of_words"
# functions of C that a kernel may call: found in every process
CALLABLE = {
    "sin",
    "cos",
    "sqrt",
    "atan2",
    "memset",
    "memcpy",
    "memmove",
    "exp",
    "log",
    "pow",
    "fmod",
    "hypot",
}
WRAPPER = re.compile(r"^define [^\n]*@_ZN7cpython.*?^}\n", re.MULTILINE | re.DOTALL)
_engines: list[Any] = []  # they own the code that is called


class ObjectCode:
    """A function that Python calls, by object code where that is on disk, else by a dispatcher of numba."""

    def __init__(
        self, function: Callable[..., Any], dispatcher: Callable[[], Any], folder: Path | None, digest: str
    ) -> None:
        self.py_func, self.dispatcher = function, functools.cache(dispatcher)  # numba's own way to it
        self.folder, self.digest = folder, digest
        self._by_types: dict[tuple[Any, ...], Callable[[Any], int] | None] = {}  # None: numba does it
        self._lock = threading.Lock()

    def on_disk(self) -> bool:
        """Return whether object code of the sources as they are is on disk, whatever the arguments."""
        return self.folder is not None and any(self.folder.glob(f"{self._name()}-*.o"))

    def __call__(self, *values: Any) -> None:
        """Call the function; the first call of arguments of such types loads it, or compiles it."""
        words: list[int] = []
        types: list[Any] = []
        for value in values:
            _flatten(value, words, types)
        key = tuple(types)
        if key not in self._by_types:
            with self._lock:
                if key not in self._by_types and not self._load(key):
                    self._compile(values, key, len(words))
                    return
        run = self._by_types[key]
        if run is None or run(np.array(words, np.int64).ctypes.data) != 0:
            self.dispatcher()(*values)

    def _name(self) -> str:
        return f"{self.py_func.__name__}-{self.digest}"

    def _path(self, key: tuple[Any, ...]) -> Path | None:
        if self.folder is None or sys.platform not in TRIED_ON:
            return None
        import llvmlite.binding as llvm

        made_by = (sys.version, *_releases())
        processor = (llvm.get_host_cpu_name(), llvm.get_host_cpu_features().flatten())
        digest = hashlib.sha256(repr((key, made_by, processor)).encode()).hexdigest()[:16]
        return self.folder / f"{self._name()}-{digest}.o"

    def _load(self, key: tuple[Any, ...]) -> bool:
        """Find the function of the words on disk, and say whether it is there and whole."""
        path = self._path(key)
        if path is None or not path.is_file():
            return False
        data = path.read_bytes()
        if hashlib.sha256(data[32:]).digest() != data[:32]:
            return False
        import llvmlite.binding as llvm

        llvm.initialize_native_target()
        llvm.initialize_native_asmprinter()
        engine = llvm.create_mcjit_compiler(llvm.parse_assembly(""), _machine(llvm))
        engine.add_object_file(llvm.ObjectFileRef.from_data(data[32:]))
        engine.finalize_object()
        _engines.append(engine)
        # the lock of the interpreter is free meanwhile, as in numba's nogil
        self._by_types[key] = ctypes.CFUNCTYPE(ctypes.c_int, ctypes.c_void_p)(
            engine.get_function_address(THUNK)
        )
        return True

    def _compile(self, values: Sequence[Any], key: tuple[Any, ...], count: int) -> None:
        """Call the function through numba, which compiles it, and write what it made as an object file."""
        dispatcher, path = self.dispatcher(), self._path(key)
        before = set(dispatcher.overloads)
        dispatcher(*values)
        self._by_types[key] = None
        fresh = set(dispatcher.overloads) - before
        if path is None or len(fresh) != 1 or dispatcher.stats.cache_hits:
            return  # of what numba reads from its own cache the text is not at hand
        import llvmlite.binding as llvm

        try:
            [signature] = fresh
            name = dispatcher.overloads[signature].fndesc.llvm_func_name
            text = WRAPPER.sub("", dispatcher.inspect_llvm(signature))
            module = llvm.parse_assembly(text)
            arguments = [str(value.type) for value in module.get_function(name).arguments][2:]
            outside = {other.name for other in module.functions if other.is_declaration} - CALLABLE
            called = [other for other in outside if len(re.findall(rf"@{re.escape(other)}\(", text)) > 1]
            if len(arguments) != count or any(not other.startswith("llvm.") for other in called):
                return
            module.link_in(llvm.parse_assembly(_thunk(name, arguments)))
            code = _machine(llvm).emit_object(module)
        except (AttributeError, KeyError, NameError, RuntimeError):
            return  # a release of numba that holds its functions in another way
        _write(path, hashlib.sha256(code).digest() + code)


@functools.cache
def _releases() -> tuple[str, ...]:
    """Return the releases of numba and llvmlite that are installed, by the names of their folders."""
    numba = find_spec("numba")
    installed = Path(str(numba.origin)).parents[1] if numba else Path()
    return tuple(sorted(path.name for name in ("numba", "llvmlite") for path in installed.glob(f"{name}-*")))


def _flatten(value: Any, words: list[int], types: list[Any]) -> None:
    """Append the words of a value as numba hands it on, and its type."""
    if isinstance(value, np.ndarray):
        shape, strides = value.shape, value.strides
        words += (0, 0, value.size, value.itemsize, value.__array_interface__["data"][0], *shape, *strides)
        types.append((value.dtype, len(shape), value.flags.c_contiguous, value.flags.writeable))
    elif isinstance(value, tuple):
        types.append((type(value).__name__, len(value)))
        for part in value:
            _flatten(part, words, types)
    elif isinstance(value, (bool, np.bool_)):
        words.append(int(value))
        types.append("bool")
    elif isinstance(value, (int, np.integer)):
        words.append(int(value))
        types.append("int")
    else:
        words.append(struct.unpack("q", struct.pack("d", value))[0])
        types.append("float")


def _thunk(name: str, arguments: Sequence[str]) -> str:
    """Return the text of a function that reads the arguments of another one from words, and calls it."""
    lines: list[str] = []
    values: list[str] = []
    for k, kind in enumerate(arguments):
        lines += [f"  %p{k} = getelementptr i64, ptr %words, i64 {k}", f"  %w{k} = load i64, ptr %p{k}"]
        values.append(f"i64 %w{k}" if kind == "i64" else f"{kind} %v{k}")
        if kind != "i64":
            cast = {"ptr": "inttoptr", "double": "bitcast"}.get(kind, "trunc")
            lines.append(f"  %v{k} = {cast} i64 %w{k} to {kind}")
    types = ", ".join(["ptr", "ptr", *arguments])
    return "\n".join([
        f'declare i32 @"{name}"({types})',
        f"define i32 @{THUNK}(ptr %words) {{",
        "  %result = alloca [16 x i64]",
        "  %fault = alloca ptr",
        *lines,
        f'  %status = call i32 @"{name}"(ptr %result, ptr %fault, {", ".join(values)})',
        "  ret i32 %status",
        "}",
    ])  # fmt: skip


def _machine(llvm: Any) -> Any:
    """Return the target machine of this processor, as numba sets it."""
    target = llvm.Target.from_triple(llvm.get_process_triple())
    return target.create_target_machine(
        cpu=llvm.get_host_cpu_name(),
        features=llvm.get_host_cpu_features().flatten(),
        opt=3,
        reloc="static" if target.name.startswith("x86") else "default",
        codemodel="jitdefault",
        jit=True,
    )


def _write(path: Path, data: bytes) -> None:
    """Write a file under another name first; nothing where the folder takes none."""
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(dir=path.parent)
        with os.fdopen(handle, "wb") as file:
            file.write(data)
        Path(name).replace(path)
    except OSError:
        return
