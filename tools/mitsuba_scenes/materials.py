"""BSDFs as materials of vkpm."""

from dataclasses import dataclass

import numpy as np

from mitsuba_scenes.images import Change, Images
from mitsuba_scenes.source import Node, colour, mi, number

BSDF, TEXTURE = mi.ObjectType.BSDF, mi.ObjectType.Texture
LUMINANCE = np.float32((0.212671, 0.71516, 0.072169))
AIR = 1.001  # what refracts less counts as nothing
NAMED_IOR = {"vacuum": 1.0, "helium": 1.000036, "hydrogen": 1.000132, "air": 1.000277, "carbon dioxide": 1.00045}


@dataclass
class Attribute:
    """Colours that a mesh has, times a scale, and what is done to them."""

    name: str
    scale: float
    change: Change | None

    def of(self, values: dict, faces: np.ndarray) -> np.ndarray | None:
        """For each corner of the faces a colour; none if the mesh has no such attribute."""
        if self.name not in values:
            return None
        by_vertex = self.name.startswith("vertex_")
        count = len(values["vertex_positions"]) // 3 if by_vertex else len(faces)
        found = np.array(values[self.name], float).reshape(count, -1)
        found = np.broadcast_to(found[:, :3] if found.shape[1] >= 3 else found[:, :1], (len(found), 3)) * self.scale
        found = self.change(found) if self.change else found
        return found[faces] if by_vertex else np.repeat(found[:, None], 3, axis=1)


class Materials:
    """The materials of a scene by their names; each BSDF becomes one."""

    def __init__(self, images: Images):
        self.images = images
        self.found: dict[str, dict] = {}
        self.names: dict[tuple[int, bool, tuple[float, float]], str] = {}
        self.colours: dict[str, Attribute] = {}  # of meshes, by which those of their materials are multiplied
        self.attribute: Attribute | None = None
        self.upward = True
        self.stretch: tuple[float, float] = 1, 1

    def name(self, node: Node, upward: bool = True, stretch: tuple[float, float] = (1, 1)) -> str | None:
        """That of a BSDF's material; none for what nobody sees. What hangs on the shape: `upward` says whether the
        green of normal maps goes up in their images, `stretch` how long its steps of u and v are, for bump maps."""
        self.upward = upward or not relief(node)
        self.stretch = stretch if relief(node) else (1, 1)
        key = node.index, self.upward, self.stretch
        if key not in self.names:
            self.attribute = None
            material = self.read(node)
            if material is None:
                return None
            name = node.props.id()
            name = name if name and "__" not in name else f"{node.plugin} {len(self.found) + 1}"
            while name in self.found:
                name += "'"
            self.found[name] = material
            if self.attribute:
                self.colours[name] = self.attribute
            self.names[key] = name
        return self.names[key]

    def value(self, node: Node, name: str, default: float, change: Change | None = None, grey: bool = False):
        """A colour, a number or a texture."""
        child = node.child(name)
        if child is not None and child.plugin == "mesh_attribute" and not grey:
            return self.colours_of_mesh(child, change)
        if child is not None:
            return self.images.texture(child, change, grey)
        values = np.broadcast_to(node.value(name, default), 3).astype(float)
        values = change(values) if change else values
        return number(values.mean()) if grey else colour(values)

    def colours_of_mesh(self, node: Node, change: Change | None) -> float:
        """A white that the colours in a mesh's file multiply."""
        attribute = Attribute(node.get("name"), float(node.get("scale", 1)), change)
        if self.attribute and self.attribute.name != attribute.name:
            node.lose("a second attribute of meshes in a material; 0.5 stands for it")
            return 0.5
        self.attribute = attribute
        return 1

    def roughness(self, node: Node) -> dict | float:
        """The root of alpha, as vkpm has it."""
        if node.get("distribution", "beckmann") == "beckmann":
            node.lose("Beckmann's distribution of facets (GGX of the same alpha stands for it)")
        if "alpha_u" in node or "alpha_v" in node:
            values = [self.value(node, name, 0.1, grey=True) for name in ("alpha_u", "alpha_v")]
            if any(isinstance(value, dict) for value in values):
                node.lose("textures of alpha_u and alpha_v; 0.1 stands for them")
                return number(0.1**0.5)
            if values[0] != values[1]:
                node.lose("anisotropic roughness; its geometric mean stays")
            return number((values[0] * values[1]) ** 0.25)
        return self.value(node, "alpha", 0.1, np.sqrt, grey=True)

    def read(self, node: Node) -> dict | None:
        """A material by its plugin."""
        reader = getattr(self, f"read_{node.plugin}", None)
        if reader is not None:
            return reader(node)
        node.lose(f"BSDFs of type {node.plugin}; a diffuse grey of 0.5 stands for them")
        return {"type": "diffuse", "albedo": 0.5}

    # What holds others.

    def nested(self, node: Node) -> dict | None:
        """The first BSDF within."""
        return self.read(node.children(BSDF)[0])

    def read_twosided(self, node: Node) -> dict | None:
        if len(node.children(BSDF)) > 1:
            node.lose("a second BSDF of twosided, for the back; the front's is on both sides")
        return self.nested(node)

    def read_mask(self, node: Node) -> dict | None:
        material = self.nested(node)
        if material is None:
            return None
        opacity = self.value(node, "opacity", 0.5, grey=True)
        return material if opacity == 1 else material | {"opacity": opacity}

    def read_normalmap(self, node: Node) -> dict | None:
        material = self.nested(node)
        texture = next(iter(node.children(TEXTURE)), None)
        if material is None or texture is None or material["type"] == "mirror":
            return material
        change = None if self.upward else lambda values: values * (1, -1, 1) + (0, 1, 0)
        if change is None and not texture.get("raw", False):
            change = np.asarray
        found = self.images.texture(texture, change, grey=False)
        return material | ({"normalMap": found} if isinstance(found, dict) else {})

    def read_bumpmap(self, node: Node) -> dict | None:
        """A normal map of the same slopes."""
        material = self.nested(node)
        texture = next(iter(node.children(TEXTURE)), None)
        if material is None or texture is None or material["type"] == "mirror":
            return material
        if texture.plugin != "bitmap":
            node.lose("bump maps that are no images")
            return material
        height = float(node.get("scale", 1))
        turn = np.array(texture.values["to_uv"].matrix, float)[:2, :2]
        edges = "wrap" if texture.get("wrap_mode", "repeat") == "repeat" else "edge"

        def normals(values: np.ndarray) -> np.ndarray:
            heights = height * np.pad(values @ LUMINANCE, 1, edges)
            along = np.stack([(heights[1:-1, 2:] - heights[1:-1, :-2]) * values.shape[1] / 2,
                              (heights[2:, 1:-1] - heights[:-2, 1:-1]) * values.shape[0] / 2], -1)
            slopes = along @ turn / self.stretch  # v goes down, green up
            found = np.dstack([-slopes[..., 0], slopes[..., 1], np.ones_like(slopes[..., 0])])
            return 0.5 + 0.5 * found / np.linalg.norm(found, axis=-1, keepdims=True)

        return material | {"normalMap": self.images.texture(texture, normals, grey=False)}

    def read_blendbsdf(self, node: Node) -> dict | None:
        weight = self.value(node, "weight", 0.5, grey=True)
        node.lose("mixtures (blendbsdf); the BSDF of the greater weight stays")
        first, second = node.children(BSDF)
        return self.read(second if not isinstance(weight, dict) and weight > 0.5 else first)

    def read_null(self, node: Node) -> dict | None:
        return None

    # Surfaces.

    def read_diffuse(self, node: Node) -> dict:
        return {"type": "diffuse", "albedo": self.value(node, "reflectance", 0.5)}

    def read_roughdiffuse(self, node: Node) -> dict:
        node.lose("roughness of diffuse surfaces")
        return self.read_diffuse(node)

    def read_plastic(self, node: Node) -> dict:
        eta = ior_of(node, 1.49)
        return {"type": "plastic", "ior": number(eta), "roughness": 0,
                "albedo": self.base(node, 1, mi.fresnel_diffuse_reflectance(1 / eta))}

    def read_roughplastic(self, node: Node) -> dict:
        return {"type": "plastic", "ior": number(ior_of(node, 1.49)), "roughness": self.roughness(node),
                "albedo": self.base(node, *rough_base(node))}

    def read_pplastic(self, node: Node) -> dict:
        node.lose("polarizing plastics; plain ones stand for them")
        return self.read_plastic(node) | {"roughness": self.roughness(node)}

    def base(self, node: Node, factor: float, inside: float):
        """The albedo below a coat. Mitsuba's base is separable as vkpm's is, but for a factor; where light is coloured
        each time that it comes back from the coat, which reflects a part of it `inside` ("nonlinear"), the albedo
        takes that in."""
        if "specular_reflectance" in node and self.value(node, "specular_reflectance", 1) != 1:
            node.lose("specular_reflectance of plastics")
        if node.get("nonlinear", False):
            return self.value(node, "diffuse_reflectance", 0.5,
                              lambda rho: factor * rho * (1 - inside) / (1 - rho * inside))
        return self.value(node, "diffuse_reflectance", 0.5, lambda rho: factor * rho) if factor != 1 else self.value(
            node, "diffuse_reflectance", 0.5)

    def read_conductor(self, node: Node) -> dict:
        eta, k = (np.broadcast_to(node.value(name, 0), 3).astype(float) for name in ("eta", "k"))
        facing = ((eta - 1) ** 2 + k**2) / ((eta + 1) ** 2 + k**2)
        reflectance = self.value(node, "specular_reflectance", 1, lambda factor: factor * facing)
        if node.get("material") == "none" and node.plugin == "conductor" and not isinstance(reflectance, dict):
            return {"type": "mirror", "reflectance": reflectance}
        return {"type": "metal", "reflectance": reflectance}

    def read_roughconductor(self, node: Node) -> dict:
        return self.read_conductor(node) | {"roughness": self.roughness(node), "multiscatter": False}

    def glass(self, node: Node) -> dict:
        eta, outside = ior_of(node, 1.5046), named_ior(node.get("ext_ior", "air"))
        glass = {"type": "glass", "ior": number(eta)}
        if outside > AIR:
            glass |= {"ior": number(eta * outside), "exteriorIor": number(outside)}
        reflects, transmits = (self.value(node, f"specular_{name}", 1) for name in ("reflectance", "transmittance"))
        if isinstance(reflects, dict) or isinstance(transmits, dict):
            node.lose("textures of glass")
        elif transmits != 1 or reflects != 1:
            glass["tint"] = transmits
            if transmits != reflects:
                node.lose("different factors for what glass reflects and transmits; the latter counts for both")
        return glass

    def read_dielectric(self, node: Node) -> dict:
        return self.glass(node)

    def read_thindielectric(self, node: Node) -> dict:
        return self.glass(node) | {"thin": True}

    def read_roughdielectric(self, node: Node) -> dict:
        return self.glass(node) | {"roughness": self.roughness(node)}

    def read_principled(self, node: Node) -> dict:
        node.lose("Disney's principled BSDF (glTF's metallic-roughness stands for it, with base_color, metallic, "
                  "roughness, specular and spec_trans)")
        transmission = self.value(node, "spec_trans", 0, grey=True)
        material = {"type": "standard", "baseColor": self.value(node, "base_color", 0.5),
                    "metallic": self.value(node, "metallic", 0, grey=True),
                    "roughness": self.value(node, "roughness", 0.5, grey=True)}
        if not isinstance(transmission, dict) and transmission > 0.5:
            return material | {"transmission": 1, "metallic": 0, "ior": number(node.get("eta", 1.5))}
        if "eta" in node:
            return material | {"ior": number(node.get("eta"))}
        root = (0.08 * float(node.value("specular", 0.5))) ** 0.5  # of the reflectance at normal incidence
        return material | {"ior": number((1 + root) / (1 - root))}


def relief(node: Node) -> bool:
    """Whether a BSDF has a normal map or a bump map."""
    return node.plugin in ("normalmap", "bumpmap") or any(relief(child) for child in node.children(BSDF))


def rough_base(node: Node) -> tuple[float, float]:
    """What remains of a white base below a rough coat, in parts of what vkpm gives back, and what the coat reflects
    inside. Both are measured: rough coats of Mitsuba lose light."""
    shared = {"type": "roughplastic", "alpha": float(node.get("alpha", 0.1)), "nonlinear": True,
              "int_ior": ior_of(node, 1.49), "ext_ior": 1.0, "distribution": node.get("distribution", "beckmann")}
    ggx = mi.load_dict(shared | {"distribution": "ggx", "diffuse_reflectance": {"type": "uniform", "value": 0.0}})
    black, grey, white = (mi.load_dict(shared | {"diffuse_reflectance": {"type": "uniform", "value": value}})
                          for value in (0.0, 0.5, 1.0))
    context, point = mi.BSDFContext(), mi.SurfaceInteraction3f()

    def scattered(bsdf, mu: float, mu_out: float) -> float:
        """f at two cosines."""
        directions = [mi.Vector3f((1 - x * x) ** 0.5 * side, 0, x) for x, side in ((mu, 1), (mu_out, 1))]
        point.wi = directions[0]
        return float(bsdf.eval(context, point, directions[1])[0]) / mu_out

    def below(bsdf, mu: float, mu_out: float) -> float:
        """The base's part of it."""
        return scattered(bsdf, mu, mu_out) - scattered(black, mu, mu_out)

    def coat(mu: float) -> float:
        """What vkpm's coat reflects."""
        point.wi = mi.Vector3f((1 - mu * mu) ** 0.5, 0, mu)
        places = (np.arange(16) + 0.5) / 16
        return float(np.mean([ggx.sample(context, point, 0.5, (u, v))[1][0] for u in places for v in places]))

    cosines, weights = np.polynomial.legendre.leggauss(12)
    cosines, weights = (cosines + 1) / 2, weights / 2
    one = 0.5
    along = sum(weight * mu * below(white, mu, one) for mu, weight in zip(cosines, weights, strict=True))
    base = 4 * np.pi * along**2 / below(white, one, one)
    rest = 1 - 2 * sum(weight * mu * coat(mu) for mu, weight in zip(cosines, weights, strict=True))
    ratio = below(white, one, one) / below(grey, one, one)
    return float(base / rest), float((ratio - 2) / (ratio - 1))


def named_ior(value) -> float:
    """The index of a medium outside, by number or name; names of what is no gas make Mitsuba compare it with air."""
    if not isinstance(value, str):
        return float(value)
    if value in NAMED_IOR:
        return NAMED_IOR[value]
    return mi.traverse(mi.load_dict({"type": "dielectric", "int_ior": value, "ext_ior": "vacuum"}))["eta"]


def ior_of(node: Node, default: float) -> float:
    """The ratio of the indices inside and outside."""
    if "eta" in node.values:
        return float(node.values["eta"])
    return named_ior(node.get("int_ior", default)) / named_ior(node.get("ext_ior", "air"))
