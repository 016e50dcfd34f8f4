"""The one composer of stages: training, compiling, checking, evaluating."""
