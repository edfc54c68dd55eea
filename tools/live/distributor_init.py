"""NumPy's hook for distributors. Pyodide's main module lacks `backtrace`, which NumPy calls for
temporaries over 256 KiB, and the call ends the program. Give it one that finds no frames."""

import sys

if sys.platform == "emscripten":
    import pyodide_js
    from pyodide.code import run_js

    run_js("(m) => { m.LDSO.loadedLibsByName.__main__.exports.backtrace = () => 0; }")(
        pyodide_js._module
    )
