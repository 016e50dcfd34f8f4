"""Hardware building blocks: Amaranth components, each with its golden model beside it."""
