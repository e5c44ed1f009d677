"""BSDFs as materials of vkpm."""

import numpy as np

from mitsuba_scenes.images import Change, Images
from mitsuba_scenes.source import Node, colour, mi, number

BSDF, TEXTURE = mi.ObjectType.BSDF, mi.ObjectType.Texture
AIR = 1.001  # what refracts less counts as nothing
NAMED_IOR = {"vacuum": 1.0, "helium": 1.000036, "hydrogen": 1.000132, "air": 1.000277, "carbon dioxide": 1.00045}


class Materials:
    """The materials of a scene by their names; each BSDF becomes one."""

    def __init__(self, images: Images):
        self.images = images
        self.found: dict[str, dict] = {}
        self.names: dict[int, str] = {}

    def name(self, node: Node) -> str | None:
        """That of a BSDF's material; none for what nobody sees."""
        if node.index not in self.names:
            material = self.read(node)
            if material is None:
                return None
            name = node.props.id() or f"{node.plugin} {len(self.found) + 1}"
            while name in self.found:
                name += "'"
            self.found[name] = material
            self.names[node.index] = name
        return self.names[node.index]

    def textured(self, node: Node) -> bool:
        """Whether a material looks at texture coordinates."""
        material = self.found.get(self.names.get(node.index, ""), {})
        return any(isinstance(value, dict) and "texture" in value for value in material.values())

    def value(self, node: Node, name: str, default: float, change: Change | None = None, grey: bool = False):
        """A colour, a number or a texture."""
        child = node.child(name)
        if child is not None:
            return self.images.texture(child, change, grey)
        values = np.broadcast_to(node.value(name, default), 3).astype(float)
        values = change(values) if change else values
        return number(values.mean()) if grey else colour(values)

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
        texture = next((child for child in node.children(TEXTURE)), None)
        if material is None or texture is None or material["type"] == "mirror":
            return material
        found = self.images.texture(texture, None, grey=False)
        return material | ({"normalMap": found | {"space": "linear"}} if isinstance(found, dict) else {})

    def read_bumpmap(self, node: Node) -> dict | None:
        node.lose("bump maps (a normal map does the same, if you make one)")
        return self.nested(node)

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
        return {"type": "plastic", "albedo": self.base(node, eta), "ior": number(eta), "roughness": 0}

    def read_roughplastic(self, node: Node) -> dict:
        return self.read_plastic(node) | {"roughness": self.roughness(node)}

    def read_pplastic(self, node: Node) -> dict:
        return self.read_roughplastic(node)

    def base(self, node: Node, eta: float):
        """What lies under a coat. Mitsuba's linear base is vkpm's separable one; where light is coloured each time that
        it comes back from the coat ("nonlinear"), the albedo takes that in."""
        if "specular_reflectance" in node and self.value(node, "specular_reflectance", 1) != 1:
            node.lose("specular_reflectance of plastics")
        if not node.get("nonlinear", False):
            return self.value(node, "diffuse_reflectance", 0.5)
        inside = mi.fresnel_diffuse_reflectance(1 / eta)
        return self.value(node, "diffuse_reflectance", 0.5, lambda rho: rho * (1 - inside) / (1 - rho * inside))

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
