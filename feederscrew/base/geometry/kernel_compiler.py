"""Compiler of kernels: by numba into code of LLVM, with what numba documents for its users alone.

numba itself hands on a named tuple as every number behind it, some hundred for a workspace, at each call, and
spells all of their types in the name of each function. Here it is one address, behind which its fields lie as
words.
"""

import hashlib
from collections.abc import Callable, Iterator, Sequence
from itertools import accumulate
from typing import Any

import numpy as np
from llvmlite import binding, ir
from numba import cfunc, extending, from_dtype, njit, types

from feederscrew.base.signatures import Keywords

RESULTS = {float: types.float64, int: types.int64, bool: types.boolean, None: types.void}

WORD = ir.IntType(64)
OPTIONS: Keywords = {"error_model": "numpy", "forceinline": True}  # of what reads words


class HandedRecord(types.Type):
    """A named tuple behind an address; each field with its type and the place of its first word."""

    def __init__(self, name: str, fields: Sequence[str], kinds: Sequence[Any]) -> None:
        text = " ".join(map(str, kinds))
        super().__init__(f"{name}_{hashlib.sha256(text.encode()).hexdigest()[:8]}")
        self.fields = dict(zip(fields, zip(kinds, _places(kinds)), strict=True))


extending.register_model(HandedRecord)(extending.models.OpaqueModel)


DECLARED: set[str] = set()  # names of fields that numba is told of


def _declare_field(name: str) -> None:
    """Let compiled code read a field of that name from any record that has one."""
    if name in DECLARED:
        return
    DECLARED.add(name)

    @extending.overload_attribute(HandedRecord, name, jit_options=OPTIONS)  # type: ignore[call-arg]  # of `overload`
    def read(record):  # type: ignore[no-untyped-def]  # numba compares the names of parameters with their types
        return _reader(*record.fields[name]) if name in record.fields else None


def _places(kinds: Sequence[Any]) -> Iterator[int]:
    """Where values of some types begin that lie one behind the other."""
    return accumulate(map(_words_of, kinds[:-1]), initial=0)


def _words_of(kind: Any) -> int:
    """Return how many words of eight bytes a value of a type takes: of an array its address and shape."""
    if isinstance(kind, types.Array):
        return 1 + kind.ndim
    if isinstance(kind, HandedRecord):
        return sum(_words_of(field) for field, _ in kind.fields.values())
    return sum(map(_words_of, _items(kind))) if isinstance(kind, types.BaseTuple) else 1


def _items(kind: Any) -> tuple[Any, ...]:
    """The types of a tuple's items."""
    return tuple(kind.types)


def _reader(kind: Any, place: int = 0) -> Callable[[Any], Any]:
    """A function to be compiled: the value of a type that lies at a place behind an address.

    It is one instruction to numba: a call of ``carray`` and those of its arguments take longer to compile.
    """

    @extending.intrinsic
    def load(typing_context: Any, record: Any) -> Any:
        def emit(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            words = builder.bitcast(arguments[0], WORD.as_pointer())
            return _load(context, builder, kind, words, place)

        return kind(record), emit

    return lambda record: load(record)  # type: ignore[call-arg]  # numba gives the context


def _load(context: Any, builder: Any, kind: Any, words: Any, place: int) -> Any:
    """Emit the reading of a value of a type whose first word lies at a place."""
    if isinstance(kind, types.Array):
        return _load_array(context, builder, kind, words, place)
    if isinstance(kind, types.BaseTuple):
        items = _items(kind)
        places = [place + first for first in _places(items)]
        values = [_load(context, builder, item, words, at) for item, at in zip(items, places, strict=True)]
        return context.make_tuple(builder, kind, values)
    if isinstance(kind, HandedRecord):
        return builder.bitcast(builder.gep(words, [WORD(place)]), context.get_value_type(kind))
    if isinstance(kind, types.Boolean):
        return builder.icmp_signed("!=", _load_word(builder, WORD, words, place), WORD(0))
    return _load_word(builder, context.get_value_type(kind), words, place)


def _load_word(builder: Any, value_type: Any, words: Any, place: int) -> Any:
    """Emit the reading of a word, which stays as it is as long as the kernel runs."""
    pointer = builder.gep(words, [WORD(place)])
    loaded = builder.load(builder.bitcast(pointer, value_type.as_pointer()))
    loaded.set_metadata("invariant.load", builder.module.add_metadata([]))
    return loaded


def _load_array(context: Any, builder: Any, kind: Any, words: Any, place: int) -> Any:
    """Emit the making of an array in C order from its address and shape; nobody owns its memory."""
    item = context.get_data_type(kind.dtype)
    lengths = [_load_word(builder, WORD, words, place + 1 + k) for k in range(kind.ndim)]
    step = size = WORD(context.get_abi_sizeof(item))
    count: Any = WORD(1)
    strides: list[Any] = []
    for length in reversed(lengths):
        strides.insert(0, step)
        step = builder.mul(step, length, flags=["nsw"])
        count = builder.mul(count, length, flags=["nsw"])
    several = types.UniTuple(types.intp, kind.ndim)
    array = context.make_array(kind)(context, builder)  # zeros: of no owner and no parent
    array.data = _load_word(builder, item.as_pointer(), words, place)
    array.itemsize, array.nitems = size, count
    array.shape = context.make_tuple(builder, several, lengths)
    array.strides = context.make_tuple(builder, several, strides)
    return array._getvalue()


def register(function: Callable[..., Any], is_inlined: bool) -> None:
    """Let compiled code call a function, which becomes a part of its callers if it ``is_inlined``."""
    extending.register_jitable(error_model="numpy", forceinline=is_inlined)(function)


def numba_type(kind: Any, kind_of: dict[int, Any]) -> Any:
    """Return how numba is told a kind of argument; tuples name the kinds of their items by numbers."""
    if not isinstance(kind, tuple):
        return RESULTS[kind]
    if isinstance(kind[0], np.dtype):
        return types.Array(from_dtype(kind[0]), kind[1], "C")
    items = tuple(numba_type(kind_of[number], kind_of) for number in kind[1:])
    if kind[0] is tuple:
        return types.Tuple(items)
    for name in kind[0]._fields:
        _declare_field(name)
    return HandedRecord(kind[0].__name__, kind[0]._fields, items)


def llvm_code(function: Callable[..., Any], kinds: Sequence[Any]) -> tuple[str, Any]:
    """Return the name and module of a C function of a block of words, which calls a registered function.

    ``kinds`` are numba's types of its arguments, which lie in the block one behind the other.
    """
    read = njit(**OPTIONS)(_reader(types.Tuple(tuple(kinds))))

    def call(words: Any) -> Any:
        return function(*read(words))

    signature = RESULTS[function.__annotations__["return"]](types.CPointer(types.int64))
    code = cfunc(signature, error_model="numpy")(call)
    return code.native_name, binding.parse_assembly(code.inspect_llvm())
