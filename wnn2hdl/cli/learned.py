"""What `train` says of a model of pictures."""

from collections import Counter
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from rich.table import Table

from wnn2hdl.cli.output import printed
from wnn2hdl.evaluation.light import brighter_figures, brighter_warning
from wnn2hdl.ir import WisardModel, picture_encoder
from wnn2hdl.ir.pixel_bits import PIXEL_BIT_NAMES
from wnn2hdl.training.budget import LIGHT, NESTED, WITHIN
from wnn2hdl.training.discriminators import IDENTICAL, LEFT_OUT
from wnn2hdl.training.promise import OTHERS

_MOST_GROUPS = 3
"""Groups of identical images that are named."""


def train_summary(model: WisardModel, output: Path, images: int) -> dict[str, Any]:
    """What a model is and how it was trained, for programs.

    Args:
        model: of pictures.
        output: its file.
        images: how many it was trained on.
    """
    saturation = model.saturation
    return {
        "model": str(output),
        "classes": list(model.classes),
        "address_bits": model.address_bits,
        "rams": model.rams,
        "bits": list(model.encoder.names),
        "bleaching": model.bleaching,
        "images": images,
        "saturation": {"mean": float(saturation.mean()), "highest": float(saturation.max())},
        "brighter": brighter_figures(_shares(model), picture_encoder(model)),
        "training": dict(model.training),
    }


def _shares(model: WisardModel) -> dict[float, float]:
    """Accuracy on unseen images by exposure, if the training measured it."""
    light = model.training.get(LIGHT, {})
    return {float(exposure): figures["accuracy"] for exposure, figures in light.items()}


def train_sentence(summary: dict[str, Any]) -> str:
    """What `train_summary` found, for people."""
    saturation = summary["saturation"]
    rams = "1 RAM" if summary["rams"] == 1 else f"{summary['rams']} RAMs"
    lines = [
        f"{summary['model']}: {' / '.join(summary['classes'])}, {rams} of "
        f"{summary['address_bits']} address bits for each class, reading {','.join(summary['bits'])}",
        f"bleaching threshold {summary['bleaching']}, trained on {summary['images']} images; "
        f"{saturation['mean']:.0%} of all RAM cells are set, {saturation['highest']:.0%} in the fullest RAM",
    ]
    if LIGHT in summary["training"]:
        lines += [
            "right pixels of images that were not trained on:",
            _light_table(summary["training"][LIGHT]),
        ]
    if NESTED in summary["training"]:
        methods = summary["training"][NESTED]
        times = (f"{method} ({count} of {len(methods)})" for method, count in Counter(methods).items())
        lines.append(f"chosen inside the folds: {'; '.join(times)}")
    warning = brighter_warning(summary["brighter"])
    if warning:
        lines.append(warning)
        if all(name in PIXEL_BIT_NAMES for name in summary["bits"]):
            lines.append(
                "comparisons of channels hold in changed light, and take more LUTs: train with "
                f"--luts-per-pixel {min(WITHIN)}"
            )
    identical = summary["training"][IDENTICAL]
    if identical:
        groups = "; ".join(", ".join(names) for names in identical[:_MOST_GROUPS])
        more = f" and {len(identical) - _MOST_GROUPS} more groups" if len(identical) > _MOST_GROUPS else ""
        lines.append(
            f"images that show the same: {groups}{more}; accuracy on images that were not trained on is "
            "flattered, so keep one of each"
        )
    left_out = summary["training"][LEFT_OUT]
    if left_out["pixels"]:
        lines.append(f"{left_out['share']:.2%} of the pixels left out: not labelled, or no data")
    lines += [
        f"{point['luts']} LUTs per pixel: {point['accuracy']:.2%} in cross-validation by image, "
        f"{point['method']}, {point['model']}"
        for point in summary.get("front", ())
    ]
    return "\n".join(lines)


def _light_table(light: Mapping[str, Mapping[str, Any]]) -> str:
    table = Table("light", "all images", "worst image", f"expected on {OTHERS} other images")
    for exposure, figures in light.items():
        low, high = figures["other_images"]
        shares = f"{figures['accuracy']:.2%}", f"{figures['worst_image']:.2%}"
        table.add_row(f"x{exposure}", *shares, f"{low:.2%} to {high:.2%}")
    return printed(table)
