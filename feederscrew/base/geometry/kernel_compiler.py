"""Compiler of kernels: by numba into code of LLVM, with what numba documents for its users alone.

numba itself hands on a named tuple as every number behind it, some hundred for a workspace, at each call, and
spells all of their types in the name of each function. Here it is one address, behind which its fields lie as
words.

numba also puts the code of whatever a function calls into each of its callers, and optimises it there again.
Here each function is compiled alone and names those that it calls. LLVM links them into a kernel at the end.
"""

import functools
import hashlib
from collections.abc import Callable, Iterator, Sequence
from itertools import accumulate
from typing import Any, NamedTuple

import numpy as np
from llvmlite import binding, ir
from numba import cfunc, extending, from_dtype, njit, types

RESULTS = {float: types.float64, int: types.int64, bool: types.boolean, None: types.void}

WORD = ir.IntType(64)
INLINING_THRESHOLD = 225  # of LLVM's own at its first level


class HandedRecord(types.NamedTuple):
    """A named tuple behind an address; ``places`` says where the first word of each field lies."""

    def __init__(self, record_class: type, kinds: Sequence[Any]) -> None:
        super().__init__(kinds, record_class)
        text = " ".join(map(str, kinds))
        self.name = f"{record_class.__name__}_{hashlib.sha256(text.encode()).hexdigest()[:8]}"
        self.places = dict(zip(self.fields, _places(kinds), strict=True))


extending.register_model(HandedRecord)(extending.models.OpaqueModel)


@extending.lower_getattr_generic(HandedRecord)
def _emit_field(context: Any, builder: Any, record: HandedRecord, address: Any, name: str) -> Any:
    """Emit the reading of a field where it is read: a function for each field takes longer to compile."""
    words = builder.bitcast(address, WORD.as_pointer())
    return _load(context, builder, record.types[record.fields.index(name)], words, record.places[name])


def _places(kinds: Sequence[Any]) -> Iterator[int]:
    """Where values of some types begin that lie one behind the other."""
    return accumulate(map(_words_of, kinds[:-1]), initial=0)


def _words_of(kind: Any) -> int:
    """Return how many words of eight bytes a value of a type takes: of an array its address and shape."""
    if isinstance(kind, types.Array):
        return 1 + kind.ndim
    return sum(map(_words_of, _items(kind))) if isinstance(kind, types.BaseTuple) else 1


def _items(kind: Any) -> tuple[Any, ...]:
    """The types of a tuple's items."""
    return tuple(kind.types)


def _reader(kind: Any) -> Any:
    """A function of compiled code: the value of a type that lies behind an address."""

    @extending.intrinsic
    def read(typing_context: Any, words: Any) -> Any:
        def emit(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            return _load(context, builder, kind, arguments[0], 0)

        return kind(words), emit

    return read


def _load(context: Any, builder: Any, kind: Any, words: Any, place: int) -> Any:
    """Emit the reading of a value of a type whose first word lies at a place."""
    if isinstance(kind, types.Array):
        return _load_array(context, builder, kind, words, place)
    if isinstance(kind, HandedRecord):
        return builder.bitcast(builder.gep(words, [WORD(place)]), context.get_value_type(kind))
    if isinstance(kind, types.BaseTuple):
        items = _items(kind)
        places = [place + first for first in _places(items)]
        values = [_load(context, builder, item, words, at) for item, at in zip(items, places, strict=True)]
        return context.make_tuple(builder, kind, values)
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
    step = size = WORD(_size_of(context, kind.dtype))
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


class FunctionCode(NamedTuple):
    """A function compiled alone for arguments of some types: the functions that it calls are named in it."""

    name: str
    return_type: Any
    module: Any  # LLVM's


PARTS: dict[tuple[Callable[..., Any], tuple[Any, ...]], FunctionCode] = {}  # by the function and the types


def register(function: Callable[..., Any], is_inlined: bool) -> None:
    """Let compiled code call a function, which becomes a part of its callers if it ``is_inlined``."""

    @extending.type_callable(function)
    def type_call(context: Any) -> Callable[..., Any]:
        @functools.wraps(function)  # numba asks for the signature
        def typer(*kinds: Any) -> Any:
            if (function, kinds) not in PARTS:
                PARTS[function, kinds] = _compile_alone(function, kinds, is_inlined)
            return PARTS[function, kinds].return_type

        return typer

    @extending.lower_builtin(function, types.VarArg(types.Any))
    def emit_call(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
        kinds, result, convention = signature.args, signature.return_type, context.call_conv
        name = PARTS[function, kinds].name
        named = builder.module.globals.get(name)
        if named is None:
            named = ir.Function(builder.module, convention.get_function_type(result, kinds), name)
        _, returned = convention.call_function(builder, named, result, kinds, arguments)
        return returned  # the status tells of exceptions: kernels raise none


def _compile_alone(function: Callable[..., Any], kinds: tuple[Any, ...], is_inlined: bool) -> FunctionCode:
    """Compile a function for arguments of some types, without a way to call it from Python or C."""
    # numba takes the two last options, though its annotations do not name them
    options: Any = {"forceinline": is_inlined, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
    code = njit([kinds], error_model="numpy", **options)(function)
    module = binding.parse_assembly(code.inspect_llvm(code.signatures[0]))
    own = (f.name for f in module.functions if not f.is_declaration and f.linkage == binding.Linkage.external)
    (name,) = own
    return FunctionCode(name, code.nopython_signatures[0].return_type, module)


def numba_type(kind: Any, kind_of: dict[int, Any]) -> Any:
    """Return how numba is told a kind of argument; tuples name the kinds of their items by numbers."""
    if not isinstance(kind, tuple):
        return RESULTS[kind]
    if isinstance(kind[0], np.dtype):
        return types.Array(from_dtype(kind[0]), kind[1], "C")
    items = tuple(numba_type(kind_of[number], kind_of) for number in kind[1:])
    if kind[0] is tuple:
        return types.Tuple(items)
    return HandedRecord(kind[0], items)


def llvm_code(function: Callable[..., Any], kinds: Sequence[Any], machine: Any) -> tuple[str, Any]:
    """Return the name and module of a C function of a block of words, which calls a registered function.

    ``kinds`` are numba's types of its arguments, which lie in the block one behind the other; ``machine`` is
    llvmlite's, which the module is optimised for.
    """
    read = _reader(types.Tuple(tuple(kinds)))

    def call(words: Any) -> Any:
        return function(*read(words))

    signature = RESULTS[function.__annotations__["return"]](types.CPointer(types.int64))
    code = cfunc(signature, error_model="numpy")(call)
    module = binding.parse_assembly(code.inspect_llvm())
    _link_parts(module, code.native_name)
    _optimise(module, machine)
    return code.native_name, module


def _link_parts(module: Any, name: str) -> None:
    """Link the parts that a module calls into it, and theirs; only one function is seen from outside."""
    module_of = {part.name: part.module for part in PARTS.values()}
    while missing := [f.name for f in module.functions if f.is_declaration and f.name in module_of]:
        for part in missing:
            module.link_in(module_of[part], preserve=True)
    for function in module.functions:
        if not function.is_declaration and function.name != name:
            function.linkage = binding.Linkage.internal


def _optimise(module: Any, machine: Any) -> None:
    """Optimise a module at LLVM's first level: the second takes longer, and its code is as fast."""
    if hasattr(binding, "create_pass_builder"):
        passes = binding.create_pass_builder(machine, binding.create_pipeline_tuning_options(speed_level=1))
        passes.getModulePassManager().run(module, passes)
    else:  # llvmlite 0.43
        builder = binding.create_pass_manager_builder()
        builder.opt_level, builder.inlining_threshold = 1, INLINING_THRESHOLD
        manager = binding.create_module_pass_manager()
        machine.add_analysis_passes(manager)
        builder.populate(manager)
        manager.run(module)


@functools.cache
def _size_of(context: Any, kind: Any) -> int:
    """How many bytes an item of an array takes; LLVM is asked once, as it parses a module for each answer."""
    return int(context.get_abi_sizeof(context.get_data_type(kind)))
