"""What a report says about the network that was compiled."""

from wnn2hdl.ir import PictureEncoder, WisardModel
from wnn2hdl.ir.models import AnyModel, LogicModel
from wnn2hdl.report.build_report import ModelFigures


def model_figures(model: AnyModel) -> ModelFigures:
    """What a report says about a model."""
    if not isinstance(model, WisardModel):
        classes = model.outputs if isinstance(model, LogicModel) else model.classes
        return ModelFigures(classes, training=model.origin, kind=model.kind)
    return ModelFigures(
        classes=model.classes,
        address_bits=model.address_bits,
        rams=model.rams,
        bits=model.encoder.names if isinstance(model.encoder, PictureEncoder) else (),
        bleaching=model.bleaching,
        saturation=tuple(tuple(row) for row in model.saturation.tolist()),
        training=model.training,
        kind=model.kind,
    )
