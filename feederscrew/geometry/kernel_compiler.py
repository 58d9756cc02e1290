"""How a kernel is compiled: by numba into code of LLVM for each function, by LLVM into code of the machine.

numba itself hands on a named tuple as every number behind it, some hundred for a workspace, at each call, and
spells all of their types in the name of each function. Here it is one address, behind which its fields lie as
words. And numba makes machine code of each function by itself, which nobody would call.
"""

import hashlib
from collections.abc import Callable, Iterator, Sequence
from itertools import accumulate
from typing import Any

import numpy as np
from llvmlite import binding, ir
from numba import cfunc, extending, from_dtype, types
from numba.core import cgutils, typed_passes, untyped_passes
from numba.core.codegen import AOTCodeLibrary, AOTCPUCodegen
from numba.core.compiler import CompilerBase
from numba.core.compiler_machinery import FunctionPass, PassManager, register_pass
from numba.core.options import DefaultOptions
from numba.core.typing.templates import AttributeTemplate
from numba.np.arrayobj import make_array, populate_array

RESULTS = {float: types.float64, int: types.int64, bool: types.boolean, None: types.void}

WORD = ir.IntType(64)


class HandedRecord(types.Type):
    """A named tuple behind an address; each field with its type and the place of its first word."""

    def __init__(self, name: str, fields: Sequence[str], kinds: Sequence[Any]) -> None:
        text = " ".join(map(str, kinds))
        super().__init__(f"{name}_{hashlib.sha256(text.encode()).hexdigest()[:8]}")
        self.fields = dict(zip(fields, zip(kinds, _places(kinds)), strict=True))


extending.register_model(HandedRecord)(extending.models.OpaqueModel)


@extending.infer_getattr
class FieldOfRecord(AttributeTemplate):
    """The type of a field."""

    key = HandedRecord

    def generic_resolve(self, value: Any, attr: str) -> Any:  # type: ignore[override]  # numba's is no function
        """Return the type of a field; None of a name that is none."""
        return value.fields[attr][0] if attr in value.fields else None


@extending.lower_getattr_generic(HandedRecord)
def read_field(context: Any, builder: Any, record: HandedRecord, address: Any, name: str) -> Any:
    """Emit the reading of a field."""
    kind, place = record.fields[name]
    return _read(context, builder, kind, place, address)


def _places(kinds: Sequence[Any]) -> Iterator[int]:
    """Where values of some types begin that lie one behind the other."""
    return accumulate(map(_words_of, kinds[:-1]), initial=0)


def _words_of(kind: Any) -> int:
    """How many words of eight bytes a value of a type takes: of an array its address and shape."""
    if isinstance(kind, types.Array):
        return 1 + kind.ndim
    if isinstance(kind, HandedRecord):
        return sum(_words_of(field) for field, _ in kind.fields.values())
    return sum(map(_words_of, _items(kind))) if isinstance(kind, types.BaseTuple) else 1


def _items(kind: Any) -> list[Any]:
    return list(kind.types)


def _reader(kind: Any, place: int) -> Any:
    """A function for compiled code: the value of a type that lies at a place behind an address."""

    @extending.intrinsic
    def read(typing_context: Any, words: Any) -> Any:
        def emit(context: Any, builder: Any, signature: Any, arguments: Any) -> Any:
            return _read(context, builder, kind, place, builder.bitcast(arguments[0], cgutils.voidptr_t))

        return kind(words), emit

    return read


def _read(context: Any, builder: Any, kind: Any, place: int, address: Any) -> Any:
    """Emit the reading of a value; its words stay as they are as long as the kernel runs."""

    def word(number: int, of: Any) -> Any:
        pointer = builder.gep(builder.bitcast(address, WORD.as_pointer()), [WORD(place + number)])
        loaded = builder.load(builder.bitcast(pointer, of.as_pointer()))
        loaded.set_metadata("invariant.load", builder.module.add_metadata([]))
        return loaded

    if isinstance(kind, HandedRecord):
        return builder.gep(builder.bitcast(address, cgutils.voidptr_t), [WORD(8 * place)])
    if isinstance(kind, types.Array):  # in C order, of its address and shape
        shape = [word(1 + k, WORD) for k in range(kind.ndim)]
        data_type = context.get_data_type(kind.dtype)
        size = context.get_abi_sizeof(data_type)
        strides: list[Any] = [WORD(size)]
        for length in reversed(shape[1:]):
            strides.insert(0, builder.mul(strides[0], length))
        array, data = make_array(kind)(context, builder), word(0, data_type.as_pointer())
        populate_array(array, data=data, shape=shape, strides=strides, itemsize=size, meminfo=None)
        return array._getvalue()
    if isinstance(kind, types.BaseTuple):
        items = _items(kind)
        places = [place + first for first in _places(items)]
        values = [_read(context, builder, *each, address) for each in zip(items, places, strict=True)]
        return context.make_tuple(builder, kind, values)
    if isinstance(kind, types.Boolean):
        return builder.icmp_signed("!=", word(0, WORD), WORD(0))
    return word(0, context.get_value_type(kind))


class KernelLibrary(AOTCodeLibrary):
    """The code of a function as LLVM has it: machine code is made of a whole kernel alone."""

    def get_pointer_to_function(self, name: str) -> int:
        """Return 0, as there is no machine code, once the function is optimised."""
        self._ensure_finalized()
        return 0


class KernelCodegen(AOTCPUCodegen):
    """Makes such libraries."""

    _library_class = KernelLibrary

    def set_env(self, env_name: str, env: Any) -> None:
        """Keep no objects of Python: kernels have none."""


CODEGEN = KernelCodegen("kernels", "host")


@register_pass(mutates_CFG=False, analysis_only=True)
class ChooseLibrary(FunctionPass):
    """Lets a function be compiled into a KernelLibrary."""

    _name = "kernel_library"

    def __init__(self) -> None:
        super().__init__()

    def run_pass(self, state: Any) -> bool:
        """Give the state of a compilation its library."""
        state.library = CODEGEN.create_library(state.func_id.func_qualname)
        return False


class LeanCompiler(CompilerBase):
    """numba's compiler without the passes for what kernels do without: closures, parallel loops, branches."""

    def define_pipelines(self) -> list[PassManager]:
        """Return the passes that are made, in order."""
        passes, untyped, typed = PassManager("kernel"), untyped_passes, typed_passes
        steps: list[Any] = []
        if self.state.func_ir is None:
            steps = [untyped.TranslateByteCode, untyped.FixupArgs]
        steps += [ChooseLibrary, untyped.IRProcessing, untyped.GenericRewrites, untyped.ReconstructSSA]
        steps += [typed.NopythonTypeInference, typed.PreLowerStripPhis, typed.IRLegalization]
        steps += [typed.NativeLowering, typed.NoPythonBackend]
        for step in steps:
            passes.add_pass(step, step.__name__)
        passes.finalize()
        return [passes]


def register(function: Callable[..., Any], is_inlined: bool) -> None:
    """Let compiled code call a function, which becomes a part of its callers if it ``is_inlined``.

    No reference counting, which costs more than the arithmetic, and no way in from Python or C.
    """
    counting = {"_nrt": False} if hasattr(DefaultOptions, "_nrt") else {}
    extending.register_jitable(
        error_model="numpy",
        no_cfunc_wrapper=True,
        forceinline=is_inlined,
        pipeline_class=LeanCompiler,
        **counting,
    )(function)


def numba_type(kind: Any, kind_of: dict[int, Any]) -> Any:
    """Return how numba is told a kind of argument; tuples name the kinds of their items by numbers."""
    if not isinstance(kind, tuple):
        return RESULTS[kind]
    if isinstance(kind[0], np.dtype):
        return types.Array(from_dtype(kind[0]), kind[1], "C")
    items = tuple(numba_type(kind_of[number], kind_of) for number in kind[1:])
    return types.Tuple(items) if kind[0] is tuple else HandedRecord(kind[0].__name__, kind[0]._fields, items)


def llvm_code(function: Callable[..., Any], kinds: Sequence[Any]) -> tuple[str, Any]:
    """Return the name and module of a C function of a block of words, which calls a registered function.

    ``kinds`` are numba's types of its arguments, which lie in the block one behind the other.
    """
    names: dict[str, Any] = {"kernel": function}
    for k, (kind, place) in enumerate(zip(kinds, _places(kinds), strict=True)):
        names[f"read{k}"] = _reader(kind, place)
    call = ", ".join(f"read{k}(words)" for k in range(len(kinds)))
    exec(f"def call(words):\n    return kernel({call})\n", names)
    signature = RESULTS[function.__annotations__["return"]](types.CPointer(types.int64))
    code = cfunc(signature, error_model="numpy", pipeline_class=LeanCompiler)(names["call"])
    return code.native_name, binding.parse_assembly(code.inspect_llvm())
