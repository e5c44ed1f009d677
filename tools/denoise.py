"""Takes the noise out of a picture of vkpm by Open Image Denoise, guided by its albedo and normals."""

import argparse
import os
import signal
import sys
import tempfile
from pathlib import Path

import numpy as np
import OpenEXR
from PIL import Image

NOISY = ("direct", "specular", "caustic", "indirect")  # layers of light; of emission only edges have noise
BELIEVED = 2  # standard errors of the picture, within which the denoiser is right

Channels = dict[str, np.ndarray]  # by name, each of height and width


class Failure(Exception):
    """What ends it, with a message and an exit code: 2 for wrong input, 1 for the environment."""

    def __init__(self, message: str, code: int = 2):
        super().__init__(message)
        self.code = code


# Files.


def read(path: Path) -> tuple[Channels, dict]:
    """The channels of an EXR file, but for the state that --resume goes on from, and its attributes."""
    try:
        file = OpenEXR.File(str(path), separate_channels=True)
    except Exception as error:  # the library has no type of its own
        raise Failure(f"{path}: found no whole EXR file ({error}); allowed: a picture that vkpm rendered") from error
    if len(file.parts) != 1:
        raise Failure(f"{path}: found {len(file.parts)} parts; allowed: a picture of one part, as vkpm renders it")
    channels = {name: channel.pixels for name, channel in file.channels().items()
                if not name.startswith(("state", "residue"))}
    for name, pixels in channels.items():
        if not np.issubdtype(pixels.dtype, np.floating):
            raise Failure(f"{path}: channel {name}: found {pixels.dtype} numbers; allowed: 16 or 32-bit floats")
        if wrong := np.argwhere(~np.isfinite(pixels)).tolist():
            y, x = wrong[0]
            raise Failure(f"{path}: channel {name}: found {len(wrong)} values that are not finite, the first at pixel "
                          f"({x}, {y}); allowed: finite ones; render the picture anew")
    header = {name: value for name, value in file.header().items() if name not in ("channels", "vkpm/runs")}
    return channels, header


def vector(channels: Channels, layer: str, letters: str = "RGB") -> np.ndarray | None:
    """A layer of three channels as 32-bit floats: height, width, 3; none if the file lacks it."""
    names = [f"{layer}.{letter}" if layer else letter for letter in letters]
    if not all(name in channels for name in names):
        return None
    return np.stack([channels[name] for name in names], -1).astype(np.float32)


def replaced(channels: Channels, layer: str, values: np.ndarray) -> Channels:
    """The channels with other colours in a layer, of the same number of bits."""
    names = [f"{layer}.{letter}" if layer else letter for letter in "RGB"]
    limit = np.finfo(channels[names[0]].dtype).max
    clipped = np.clip(values, -limit, limit)
    return channels | {name: np.ascontiguousarray(clipped[..., i].astype(channels[name].dtype))
                       for i, name in enumerate(names)}


def replace(path: Path, write) -> None:
    """Writes a file beside, and renames it."""
    handle, name = tempfile.mkstemp(dir=path.parent, prefix=f".{path.stem}-", suffix=path.suffix)
    os.close(handle)
    try:
        write(name)
        umask = os.umask(0)
        os.umask(umask)
        os.chmod(name, 0o666 & ~umask)
        os.replace(name, path)
    finally:
        Path(name).unlink(missing_ok=True)


def developed(channels: Channels, stops: float) -> Image.Image:
    """Beauty as vkpm's PNG has it: 8-bit sRGB (IEC 61966-2-1) under an exposure in stops; A makes it transparent."""
    linear = vector(channels, "") * np.float32(2.0**stops)
    alpha = channels.get("A")
    if alpha is not None:
        alpha = np.clip(alpha.astype(np.float32), 0, 1)[..., None]
        linear = np.where(alpha > 0, linear / np.where(alpha > 0, alpha, 1), linear)
    linear = np.clip(linear, 0, 1)
    encoded = np.where(linear > 0.0031308, 1.055 * linear ** (1 / 2.4) - 0.055, 12.92 * linear)
    if alpha is not None:
        encoded = np.concatenate([encoded, alpha], -1)
    return Image.fromarray(np.floor(255 * encoded + 0.5).astype(np.uint8))


# Denoising.


def denoised(color: np.ndarray, albedo: np.ndarray | None, normal: np.ndarray | None) -> np.ndarray:
    """What Open Image Denoise makes of linear colours of any brightness: height, width, 3."""
    try:
        import pyoidn  # noqa: PLC0415
    except (ImportError, OSError) as error:
        raise Failure(f"Open Image Denoise is not there ({error}); tools/environment --with denoise installs it", 1
                      ) from error
    if not color.any():
        return color
    guides = {"albedo": albedo} if albedo is not None else {}
    if albedo is not None and normal is not None:  # it takes no normals alone
        guides["normal"] = normal
    try:
        return pyoidn.denoise(color, hdr=True, **guides)
    except RuntimeError as error:
        raise Failure(f"{error}; a smaller picture takes less memory", 1) from error


def trust(color: np.ndarray, smooth: np.ndarray, noise: np.ndarray) -> np.ndarray:
    """The part of a denoised picture in its mixture with the picture itself, by pixel: all of it where the two differ
    by BELIEVED of the picture's standard errors at most, and less by the square of the difference beyond, where it is
    more likely the denoiser that is wrong (after James and Stein 1961). Height, width, 1."""
    differ = ((color - smooth).astype(np.float64) ** 2).sum(-1)
    likely = BELIEVED**2 * (noise.astype(np.float64) ** 2).sum(-1)
    return np.clip(likely / np.maximum(differ, 1e-300), 0, 1)[..., None].astype(np.float32)


def denoise(channels: Channels, by_layer: bool, keep: bool) -> Channels:
    """The channels with beauty denoised, or with each layer of light denoised and beauty as their sum."""
    guides = vector(channels, "albedo"), vector(channels, "normal", "XYZ")
    beauty, noise = vector(channels, ""), vector(channels, "noise")
    layers = {layer: color for layer in NOISY if by_layer and (color := vector(channels, layer)) is not None}
    parts = layers or {"": beauty}
    change = {layer: denoised(color, *guides) - color for layer, color in parts.items()}
    total = sum(change.values())
    weight = trust(beauty, beauty + total, noise) if keep else np.float32(1)
    for layer, color in layers.items():
        channels = replaced(channels, layer, color + weight * change[layer])
    return replaced(channels, "", beauty + weight * total)


# The command.


def parse_arguments() -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="tools/denoise", allow_abbrev=False, description=__doc__)
    add = parser.add_argument
    add("image", type=Path, metavar="IN.exr", help="a picture that vkpm rendered; it stays as it is")
    add("-o", "--output", type=Path, required=True, metavar="OUT.exr",
        help="the same channels with beauty denoised; a PNG is written beside it")
    add("--by-layer", action="store_true",
        help="denoise direct, specular, caustic and indirect light each alone; beauty is their sum with emission")
    add("--everywhere", action="store_true",
        help="take what the denoiser says even where it is further off the picture than the picture's noise")
    return parser.parse_args()


def check(args: argparse.Namespace) -> None:
    """Refuses outputs that cannot be."""
    if args.output.suffix.lower() != ".exr":
        raise Failure(f"--output: found {args.output}; allowed: a name that ends in .exr")
    if not args.output.absolute().parent.is_dir():
        raise Failure(f"--output: {args.output.parent} is no folder; make it, or choose another")
    for output in (args.output, args.output.with_suffix(".png")):
        if output.exists() and args.image.exists() and output.samefile(args.image):
            raise Failure(f"--output: {output} is the picture itself; allowed: another file")


def run(args: argparse.Namespace) -> None:
    """Denoises a file."""
    check(args)
    if not args.image.is_file():
        raise Failure(f"{args.image}: there is no such file; allowed: an EXR file that vkpm rendered")
    channels, header = read(args.image)
    if vector(channels, "") is None:
        raise Failure(f"{args.image}: found channels {', '.join(sorted(channels))}; allowed: with R, G and B")
    if "vkpm/denoised" in header:
        raise Failure(f"{args.image}: found a picture that was denoised before; allowed: one as rendered")
    if args.by_layer and not any(vector(channels, layer) is not None for layer in NOISY):
        raise Failure(f"--by-layer: {args.image} has none of the layers {', '.join(NOISY)}; leave the option out")
    missing = [name for name, letters in (("albedo", "RGB"), ("normal", "XYZ"))
               if vector(channels, name, letters) is None]
    if missing:
        say(f"{args.image} has no {' and no '.join(missing)}, so that edges are guessed; --layers can have them")
    keep = not args.everywhere
    if keep and vector(channels, "noise") is None:
        say(f"{args.image} has no layer noise, so that converged pixels are denoised, too; --layers can have it")
        keep = False
    channels = denoise(channels, args.by_layer, keep)
    stops = float(header.get("vkpm/exposure", 0))
    how = "by layer" if args.by_layer else "beauty"
    header["vkpm/denoised"] = f"Open Image Denoise, {how}{', mixed by noise' if keep else ''}"
    replace(args.output, OpenEXR.File(header, dict(channels)).write)
    replace(args.output.with_suffix(".png"), developed(channels, stops).save)


def say(message: str) -> None:
    print(f"tools/denoise: {message}", file=sys.stderr)


def main() -> int:
    """Runs the command, and tells how it failed."""
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    args = parse_arguments()
    try:
        run(args)
    except Failure as failure:
        say(str(failure))
        return failure.code
    except OSError as error:
        say(str(error))
        return 1
    except KeyboardInterrupt:
        say("interrupted; nothing was written")
        return 130
    return 0


if __name__ == "__main__":
    sys.exit(main())
