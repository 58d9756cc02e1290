"""How numba compiles the kernels: in the passes that they need, and only their entries to machine code.

By itself numba optimises every function with all that it calls, and makes machine code of it. Of a kernel
only the entries are ever run: what they reach is optimised once, as a part of them. No step of the
arithmetic changes, and other users of numba in the same process keep its own compiler.
"""

import contextlib
import gc

from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import CompilerBase
from numba.core.compiler_machinery import PassManager
from numba.core.typed_passes import (
    AnnotateTypes,
    IRLegalization,
    NativeLowering,
    NoPythonBackend,
    NopythonTypeInference,
    PreLowerStripPhis,
)
from numba.core.untyped_passes import (
    FixupArgs,
    GenericRewrites,
    IRProcessing,
    ReconstructSSA,
    TranslateByteCode,
)

PASSES = (  # those for closures, generators, array expressions and parallel loops would find nothing
    *(TranslateByteCode, FixupArgs, IRProcessing, GenericRewrites, ReconstructSSA, NopythonTypeInference),
    *(PreLowerStripPhis, IRLegalization, AnnotateTypes, NativeLowering, NoPythonBackend),
)


class WholeKernel(CompilerBase):
    """Compiler of an entry, or of what several entries share."""

    def define_pipelines(self):
        """Return the one row of passes."""
        passes = PassManager("kernel")
        for one in PASSES:
            passes.add_pass(one, one.__name__)
        passes.finalize()
        return [passes]

    def compile_extra(self, func):
        """Compile a function with all that it calls."""
        with _uncollected():
            return super().compile_extra(func)


class KernelPart(WholeKernel):
    """Compiler of a function that only compiled ones call."""

    def define_pipelines(self):
        """Return the passes; their code goes to a library that is not made machine code of."""
        state = self.state
        state.library = _LinkedLibrary(state.targetctx.codegen(), state.func_id.func_qualname)
        return super().define_pipelines()


class _LinkedLibrary(JITCodeLibrary):
    """Code of a function and of all that it calls, to be linked into those that call it."""

    @property
    def codegen(self):
        """Return this library, which takes the environments of Python objects too: there are none."""
        return self

    def set_env(self, name, env):
        """Ignore an environment: the function has no Python objects."""

    def _optimize_final_module(self):
        """Optimise nothing here: the entry is optimised with all that it calls."""

    def _finalize_final_module(self):
        """Mark the library as finished without making machine code."""
        self._finalized = True


@contextlib.contextmanager
def _uncollected():
    """Switch garbage collection off: in the compiler's many objects it takes a fifteenth of the time."""
    collects = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        if collects:
            gc.enable()
