"""Hardware building blocks: Amaranth components, each with its golden model beside it.

A module holds a frozen parameter object with the golden `compute()` on NumPy arrays and the `create()` of the
hardware.
Components may be made for their ports alone, as a testbench does; the modules therefore switch off Amaranth's
warning about components that are not elaborated.
"""
