"""A build folder, from the plan to the page: the one composer of stages."""
