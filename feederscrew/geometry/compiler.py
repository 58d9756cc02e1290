"""How numba compiles the kernels: in the passes that they need, and no others.

A pipeline of one's own is numba's documented way to choose them (developer manual, "Customizing the
compiler"). No step of the arithmetic changes, and other users of numba in the same process keep its own.
"""

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


class Kernel(CompilerBase):
    """Compiler of an entry and of all that it calls."""

    def define_pipelines(self):
        """Return the one row of passes."""
        passes = PassManager("kernel")
        for one in PASSES:
            passes.add_pass(one, one.__name__)
        passes.finalize()
        return [passes]
