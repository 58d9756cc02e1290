"""Compilation of the event loops: on first need, kept on disk as object code, free of the interpreter lock.

A kernel is a C function of one block of words: numbers, and of each array its address and shape. What
`kernel_compiler` and LLVM make of it is kept. Later processes load that by llvmlite alone, in a thirtieth
of the time that numba takes to be imported and to load a kernel of its own cache.
"""

import contextlib
import ctypes
import functools
import hashlib
import importlib.util
import os
import secrets
import struct
import threading
from collections import OrderedDict
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any, TypeVar

import numpy as np

from feederscrew.base import caches

Function = TypeVar("Function", bound=Callable[..., Any])
# functions that compiled ones may call, not yet registered, and whether they become a part of their callers
PENDING: list[tuple[Callable[..., Any], bool]] = []
SMALL = 6000  # half-edges: a hull with fewer is walked sooner than numba is loaded
LIBRARY = caches.LIBRARY
KERNEL_SUFFIX = ".kernel"
MAX_KERNEL_BYTES = 100_000_000  # of a file that is read
MAX_KERNELS = 8  # kept of one function, for other arguments, processors and sources: the oldest go
# what numba's wrapper of a C function names to report an exception; a kernel raises none
UNREACHED = (
    *("numba_do_raise", "numba_gil_ensure", "numba_gil_release", "numba_unpickle"),
    *("numba_runtime_build_excinfo_struct", "NRT_Free", "NRT_MemInfo_call_dtor"),
)
# by the stage of an entry: the sources that are compiled into it
SOURCES = {
    "motion": (
        *("motion/conveying.py", "motion/hop.py", "motion/operating_point.py", "motion/point_motion.py"),
        *("motion/steady.py", "motion/waves.py"),
    ),
    "resting": ("resting/landscape.py", "resting/half_edges.py", "resting/walks.py"),
    "arrivals": ("arrivals/kernel/*.py", "resting/half_edges.py", "resting/walks.py"),
    "sorting": ("sorting/kernel.py",),
    "trials": ("trials/kernel/*.py", "arrivals/kernel/*.py"),
}


def record_type(*names: str, whole: tuple[str, ...] = (), flags: tuple[str, ...] = ()) -> np.dtype:
    """Return the dtype of a record of numbers by name, aligned as a C compiler aligns a struct.

    Parameters
    ----------
    *names : str
        Fields, in their order; those not in ``whole`` or ``flags`` are float64.
    whole : tuple of str
        Fields that are int64.
    flags : tuple of str
        Fields that are bool.

    Returns
    -------
    numpy.dtype
    """
    kinds = dict.fromkeys(whole, np.int64) | dict.fromkeys(flags, np.bool_)
    return np.dtype([(name, kinds.get(name, np.float64)) for name in names], align=True)


def zero_rows(shape: int | tuple[int, ...], kind: np.dtype) -> np.recarray:
    """Return an array of records whose numbers are all zero.

    Parameters
    ----------
    shape : int or tuple of int
    kind : numpy.dtype
        Of ``record_type``.

    Returns
    -------
    numpy.recarray
        Of the shape; fields are read as attributes.
    """
    return np.zeros(shape, kind).view(np.recarray)


def frozen_rows(values: Sequence[Sequence[float]], kind: np.dtype) -> np.recarray:
    """Return records with given values, closed to writing.

    Parameters
    ----------
    values : sequence of sequences of numbers
        A record each, its numbers in the order of the fields.
    kind : numpy.dtype
        Of ``record_type``.

    Returns
    -------
    numpy.recarray
        (N,), as many as there are sequences.
    """
    records = np.array([tuple(row) for row in values], kind).view(np.recarray)
    records.setflags(write=False)
    return records


def compiled(function: Function) -> Function:
    """Mark a function that is compiled into those that call it; called from Python it runs as it stands.

    Such a function is compiled once for all numbers it is handed, not once for each constant. It becomes a
    part of its callers, whatever its length. It makes no arrays: it is handed them. Compiled code
    hands it all of its arguments, by their order.
    """
    PENDING.append((function, True))
    return function


def outlined(function: Function) -> Function:
    """Mark a large function of few arguments that is called in several places: compiled once for all."""
    PENDING.append((function, False))
    return function


def entry(function: Function) -> Function:
    """Return a function as Python calls it, compiled; it fills arrays it is handed.

    Its annotation tells its result: None, float, int or bool.
    """
    kernel: Any = Kernel(function)  # to its callers what it was compiled from
    return function if os.environ.get("NUMBA_DISABLE_JIT", "0") not in ("", "0") else kernel


def fitting(function: Function, half_edges: int) -> Function:
    """Return a marked function as it stands or compiled, whichever is done sooner on a hull of that size.

    Parameters
    ----------
    function : callable
        Marked by ``compiled`` or ``outlined``.
    half_edges : int
        Of the hull. Up to ``SMALL`` of them are walked in Python sooner than numba is loaded.

    Returns
    -------
    callable
        It takes the same arguments and gives the same result.
    """
    return function if half_edges <= SMALL else _once(function)


def on_disk(function: Callable[..., Any]) -> bool:
    """Return whether a compiled function is on the disk already, or numba is set not to compile."""
    return not isinstance(function, Kernel) or bool(function.files())


def due(function: Callable[..., Any], half_edges: int) -> bool:
    """Return whether a marked function has to be compiled first for a hull of that size: some seconds, once.

    Parameters
    ----------
    function : callable
        Marked by ``compiled`` or ``outlined``.
    half_edges : int
        Of the hull.

    Returns
    -------
    bool
        True where ``fitting`` would compile it and no file of an earlier run holds its code.
    """
    return half_edges > SMALL and not on_disk(_once(function))


_once = functools.cache(entry)
LOADING = threading.RLock()
KINDS: dict[Any, int] = {}  # of arguments, numbered as they come
KIND_OF: dict[int, Any] = {}
MAX_REMEMBERED_TUPLES = 64  # of arguments whose words are remembered
# of tuples, by their identity, the one used last at the end
BLOCKS: OrderedDict[int, tuple[tuple[Any, ...], tuple[int, bytes]]] = OrderedDict()
ENTERED: set[Callable[..., Any]] = set()  # functions of entries that numba is told of
LOADED: list[Any] = []  # holds the code that is loaded
PACK_NUMBER, PACK_WHOLE = struct.Struct("d").pack, struct.Struct("q").pack


class Kernel:
    """A compiled function, loaded from disk at its first call, or compiled and put there.

    Each set of kinds of its arguments is compiled by itself.
    """

    def __init__(self, function: Callable[..., Any]) -> None:
        functools.update_wrapper(self, function)
        self.py_func = function
        self._runs: dict[tuple[int, ...], Callable[[bytes], Any]] = {}

    def __call__(self, *arguments: Any) -> Any:
        """Return what the function does; arrays must be in C order, whole numbers in eight bytes."""
        blocks = [_block(argument) for argument in arguments]
        kinds = tuple(kind for kind, _ in blocks)
        run = self._runs.get(kinds) or self._run(kinds)
        return run(b"".join([words for _, words in blocks]))

    def files(self) -> list[Path]:
        """Return the files that hold it, compiled from these sources."""
        folder = caches.kernel_folder()
        found = folder.glob(f"{self._stem()}-*{KERNEL_SUFFIX}") if folder else []
        return [path for path in found if path.is_file() and not path.is_symlink()]

    def _stem(self) -> str:
        return f"{self.py_func.__name__}-{_fingerprint(self.py_func.__module__)[:12]}"

    def _run(self, numbers: tuple[int, ...]) -> Callable[[bytes], Any]:
        """The function of a block of words, for arguments of some kinds."""
        with LOADING:
            if numbers not in self._runs:
                kinds, folder = [KIND_OF[number] for number in numbers], caches.kernel_folder()
                function = self.py_func
                module = function.__module__
                # all that the code depends on: another kernel under this name is none of these arguments
                identity = "\n".join(
                    [f"{module}.{function.__qualname__}", _fingerprint(module), _text(kinds), _machine()]
                )
                made_for = hashlib.sha256(identity.encode()).hexdigest()[:16]
                path = folder / f"{self._stem()}-{made_for}{KERNEL_SUFFIX}" if folder else None
                code = _read(path, identity) if path else None
                if code is None:
                    code, complete = _compile(function, kinds)
                    if path and complete:
                        _write(path, identity, code, f"{function.__name__}-*{KERNEL_SUFFIX}")
                self._runs[numbers] = _load(code, function)
            return self._runs[numbers]


def _block(value: Any) -> tuple[int, bytes]:
    """The number of an argument's kind, and its words of eight bytes as a kernel reads them.

    A kind is float, int or bool, of an array its dtype and dimensions, of a tuple its class and kinds.
    """
    kind: Any = type(value)  # asked for each argument of each call: the usual ones first, and nothing twice
    is_tuple = False
    if kind is float:
        words = PACK_NUMBER(value)
    elif kind is int:
        words = PACK_WHOLE(value)
    elif issubclass(kind, tuple):
        remembered = BLOCKS.get(id(value))
        if remembered is not None and remembered[0] is value:
            try:  # noqa: SIM105 - a context manager takes longer
                BLOCKS.move_to_end(id(value))
            except KeyError:  # another thread may have let it go
                pass
            return remembered[1]
        is_tuple, blocks = True, [_block(item) for item in value]
        kind = (kind, *[number for number, _ in blocks])
        words = b"".join([words for _, words in blocks])
    elif issubclass(kind, np.ndarray):
        if kind is not np.ndarray:
            value = np.asarray(value)  # attributes of records are slow to ask for
        kind = value.dtype, value.ndim
        words = _shape_packer(value.ndim)(_address(value), *value.shape)
    elif isinstance(value, bool | np.bool_):
        kind, words = bool, PACK_WHOLE(value)
    elif isinstance(value, int | np.integer):
        kind, words = int, PACK_WHOLE(value)
    else:
        kind, words = float, PACK_NUMBER(value)
    number = KINDS.get(kind)
    if number is None:
        with LOADING:
            number = KINDS.setdefault(kind, len(KINDS))
            KIND_OF[number] = kind
    if is_tuple:
        if len(BLOCKS) >= MAX_REMEMBERED_TUPLES:
            with contextlib.suppress(KeyError):
                BLOCKS.popitem(last=False)
        BLOCKS[id(value)] = value, (number, words)
    return number, words


@functools.cache
def _shape_packer(dimensions: int) -> Callable[..., bytes]:
    """Pack an array's address and shape into words."""
    return struct.Struct(f"{1 + dimensions}q").pack


def _address(array: np.ndarray) -> int:
    """Return the address of an array in C order.

    Raises
    ------
    ValueError
        If the array is in another order.
    """
    flags = array.flags
    if not flags.c_contiguous:
        raise ValueError(f"a kernel takes arrays in C order, not of strides {array.strides}")
    if flags.writeable and array.size:  # a quarter of what the array's own ``ctypes`` takes
        return ctypes.addressof(ctypes.c_char.from_buffer(array))  # type: ignore[arg-type]  # a buffer
    return int(array.ctypes.data)


def _text(kinds: Sequence[Any]) -> str:
    """Kinds in words that are the same in every process."""
    texts = []
    for kind in kinds:
        if isinstance(kind, type):
            texts.append(kind.__name__)
        elif isinstance(kind[0], np.dtype):
            texts.append(f"{kind[0].descr}{kind[1]}")
        else:
            items = _text([KIND_OF[number] for number in kind[1:]])
            texts.append(f"{kind[0].__module__}.{kind[0].__qualname__}({items})")
    return ", ".join(texts)


def _compile(function: Callable[..., Any], kinds: Sequence[Any]) -> tuple[bytes, bool]:
    """Compile a function for arguments of some kinds: its name and object code, and whether that is all."""
    # set before numba is imported: else other last bits than where SVML is not installed, ...
    os.environ.setdefault("NUMBA_DISABLE_INTEL_SVML", "1")
    os.environ.setdefault("NUMBA_OPT", "1")  # ... and a third more time for code that is no faster
    from feederscrew.base.geometry.kernel_compiler import llvm_code, numba_type

    if function not in ENTERED:
        ENTERED.add(function)
        compiled(function)
    _register()
    name, module = llvm_code(function, [numba_type(kind, KIND_OF) for kind in kinds], _target())
    needed = {f.name for f in module.functions if f.is_declaration and f.name.startswith(("numba_", "NRT_"))}
    return name.encode() + b"\n" + _target().emit_object(module), needed <= set(UNREACHED)


def _load(code: bytes, function: Callable[..., Any]) -> Callable[[bytes], Any]:
    """Return object code as a function of a block of words."""
    from llvmlite import binding

    name, _, content = code.partition(b"\n")
    abort = ctypes.CFUNCTYPE(None)(os.abort)
    for symbol in UNREACHED:
        if binding.address_of_symbol(symbol) is None:
            binding.add_symbol(symbol, ctypes.cast(abort, ctypes.c_void_p).value)
    engine = binding.create_mcjit_compiler(binding.parse_assembly(""), _target())
    engine.add_object_file(binding.ObjectFileRef.from_data(content))
    engine.finalize_object()
    LOADED.append((engine, abort))
    results: dict[Any, Any] = {float: ctypes.c_double, int: ctypes.c_int64, bool: ctypes.c_bool, None: None}
    result = results[function.__annotations__["return"]]
    return ctypes.CFUNCTYPE(result, ctypes.c_char_p)(engine.get_function_address(name.decode()))


@functools.cache
def _target() -> Any:
    """The machine that object code is made for, as numba makes it: this processor."""
    from llvmlite import binding

    with contextlib.suppress(RuntimeError):  # later releases of llvmlite need no such call
        binding.initialize()
    binding.initialize_native_target()
    binding.initialize_native_asmprinter()
    target = binding.Target.from_default_triple()
    return target.create_target_machine(
        cpu=binding.get_host_cpu_name(),
        features=binding.get_host_cpu_features().flatten(),
        opt=3,
        reloc="static" if target.name.startswith("x86") else "default",
        codemodel="jitdefault",
        jit=True,
    )


@functools.cache
def _machine() -> str:
    """Return what object code depends on beside its sources."""
    import llvmlite
    from llvmlite import binding

    numba = importlib.util.find_spec("numba")  # its version, without the half second of its import
    source = Path(numba.origin).with_name("_version.py") if numba and numba.origin else Path(os.devnull)
    version = hashlib.sha256(source.read_bytes()).hexdigest()
    processor = binding.get_host_cpu_name(), binding.get_host_cpu_features().flatten()
    return " ".join([version, llvmlite.__version__, binding.get_default_triple(), *processor])


def _read(path: Path, identity: str) -> bytes | None:
    """The code in a file; None where there is none, one that is damaged, another kernel's, or not our own."""
    digest, _, code = caches.read_own(path, MAX_KERNEL_BYTES).partition(b"\n")
    return code if digest == _digest(identity, code) else None


def _digest(identity: str, code: bytes) -> bytes:
    return hashlib.sha256(identity.encode() + b"\n\n" + code).hexdigest().encode()


def _write(path: Path, identity: str, code: bytes, pattern: str) -> None:
    """Keep code in a file, and of the older ones of the same function no more than are allowed."""
    partial = path.with_name(f"{secrets.token_hex(8)}{KERNEL_SUFFIX}.new")
    with contextlib.suppress(OSError):  # a full disk: it is compiled again
        if not path.parent.is_dir():
            caches.make_folder(path.parent)
        if caches.why_unsafe(path.parent, caches.KERNELS_VARIABLE):
            return
        try:
            flags = os.O_WRONLY | os.O_CREAT | os.O_EXCL | getattr(os, "O_BINARY", 0)
            with open(os.open(partial, flags, 0o600), "wb") as file:  # noqa: PTH123 - a descriptor
                file.write(_digest(identity, code) + b"\n" + code)
            partial.replace(path)
        finally:
            partial.unlink(missing_ok=True)
        files = sorted(path.parent.glob(pattern), key=lambda file: file.lstat().st_mtime, reverse=True)
        for old in files[MAX_KERNELS:]:
            if not old.is_dir() or old.is_symlink():
                old.unlink(missing_ok=True)


def _register() -> None:
    """Tell numba of the functions marked since, whichever stage was imported first."""
    from feederscrew.base.geometry.kernel_compiler import register

    while PENDING:
        register(*PENDING.pop())


@functools.cache
def _fingerprint(module: str) -> str:
    """Digest of the sources compiled into a module's entries: a changed one finds nothing of an older one."""
    stage = module.split(".")[1] if module.startswith("feederscrew.") else ""
    patterns = SOURCES.get(stage, tuple(pattern for own in SOURCES.values() for pattern in own))
    sources = sorted(path for pattern in patterns for path in LIBRARY.glob(pattern))
    digest = hashlib.sha256()
    for path in (Path(__file__), Path(__file__).with_name("kernel_compiler.py"), *sources):
        digest.update(path.read_bytes())
    return digest.hexdigest()
