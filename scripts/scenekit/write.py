"""Writes OBJ files and Nori XML scenes."""
from scenekit.vec import sub

LICENCE = "Opal's own work, MIT licence; written by scripts/make_scenes.py."


def number(x):
    """Six decimals at most, no trailing zeros: the same text on every machine."""
    text = f"{x:.6f}".rstrip("0").rstrip(".")
    return "0" if text in ("", "-0") else text


def triple(v):
    return " ".join(number(x) for x in v)


def obj_text(surface, comment):
    short = lambda v, digits: " ".join(number(round(x, digits)) for x in v)

    def corner(c):
        position, normal, uv = (str(i + 1) if i is not None else "" for i in (*c, None)[:3])
        return f"{position}/{uv}/{normal}" if normal or uv else position

    lines = [f"# {comment}", f"# {LICENCE}"]
    lines += ["v " + short(p, 5) for p in surface.positions]
    lines += ["vn " + short(n, 4) for n in surface.normals]
    lines += ["vt " + short(uv, 5) for uv in surface.uvs]
    lines += ["f " + " ".join(corner(c) for c in face) for face in surface.faces]
    return "\n".join(lines) + "\n"


# Materials and transforms: (tag, attributes) trees, an attribute list ends with its children.
def color(name, value):
    return f'<color name="{name}" value="{triple(value)}"/>'


def real(name, value):
    return f'<float name="{name}" value="{number(value)}"/>'


def boolean(name, value):
    return f'<boolean name="{name}" value="{str(value).lower()}"/>'


def bsdf(kind, *properties):
    return (f'<bsdf type="{kind}">', *properties) if properties else f'<bsdf type="{kind}"/>'


def diffuse(r, g, b, use_cosine=True):
    return bsdf("diffuse", color("albedo", (r, g, b)), *([boolean("use_cosine", True)] if use_cosine else []))


def microfacet(alpha, kd, int_ior=None):
    index = [real("intIOR", int_ior), real("extIOR", 1)] if int_ior else []
    return bsdf("microfacet", real("alpha", alpha), *index, color("kd", kd))


def phong(kd, ks, pd, n):
    return bsdf("phong", color("kd", kd), color("ks", ks), real("pd", pd), real("n", n))


def translate(*v):
    return f'<translate value="{triple(v)}"/>'


def scaling(*v):
    return f'<scale value="{triple(v if len(v) == 3 else v * 3)}"/>'


def rotate(axis, angle):
    return f'<rotate axis="{triple(axis)}" angle="{number(angle)}"/>'


def path_tracer(nee=True, mis=True):
    return ('<integrator type="path_tracer_recursive">', boolean("rr", True), boolean("nee", nee), boolean("mis", mis))


class Scene:
    """A scene in the order it is written: what it is for, how it is rendered, the camera, then its meshes."""

    def __init__(self, name, purpose, integrator=None, spp=64, filter="box"):
        self.name, self.purpose, self.filter, self.meshes = name, purpose, filter, []
        self.head = [integrator or path_tracer(),
                     ('<sampler type="independent">', f'<integer name="sampleCount" value="{spp}"/>')]

    def camera(self, origin, target, fov, width, height, far=None, lens=None):
        """lens: its radius and the depth that is seen sharply; without one the camera is a pinhole."""
        kind = "thinlens" if lens else "perspective"
        self.head.append((f'<camera type="{kind}">', f'<integer name="width" value="{width}"/>',
                          f'<integer name="height" value="{height}"/>', real("fov", fov),
                          *([real("farClip", far)] if far else []),
                          *([real("lensRadius", lens[0]), real("focalDistance", lens[1])] if lens else []),
                          ('<transform name="toWorld">',
                           f'<lookat origin="{triple(origin)}" target="{triple(target)}" up="0 1 0"/>'),
                          f'<rfilter type="{self.filter}"/>'))

    def mesh(self, obj, material, *transform, radiance=None):
        """An OBJ of scenes/meshes, moved by the transforms in their order."""
        up = "../" * self.name.count("/")
        self._add('<mesh type="obj">', [f'<string name="filename" value="{up}meshes/{obj}.obj"/>'], material, transform, radiance)

    def parallelogram(self, origin, u, v, material, radiance=None):
        """Front and emitting side is u x v."""
        shape = [f'<point name="origin" value="{triple(origin)}"/>', f'<vector name="u" value="{triple(u)}"/>',
                 f'<vector name="v" value="{triple(v)}"/>']
        self._add('<mesh type="parallelogram">', shape, material, (), radiance)

    def quad(self, a, b, d, material, radiance=None):
        """The parallelogram with corner a and its neighbours b and d; the front sees a, b, d counter-clockwise."""
        self.parallelogram(a, sub(b, a), sub(d, a), material, radiance)

    def spot(self, position, target, intensity, cutoff, beam):
        """A light at `position` that points at `target`: full to `beam` degrees from its axis, none from `cutoff` on."""
        self.meshes.append(('<emitter type="spot">', f'<point name="position" value="{triple(position)}"/>',
                            f'<vector name="direction" value="{triple(sub(target, position))}"/>',
                            color("intensity", intensity), real("cutoffAngle", cutoff), real("beamWidth", beam)))

    def sun(self, direction, irradiance):
        """Parallel light that goes to `direction`."""
        self.meshes.append(('<emitter type="directional">', f'<vector name="direction" value="{triple(direction)}"/>',
                            color("irradiance", irradiance)))

    def sphere(self, center, radius, material, radiance=None):
        self._add('<mesh type="sphere">', [f'<point name="center" value="{triple(center)}"/>', real("radius", radius)],
                  material, (), radiance)

    def _add(self, tag, shape, material, transform, radiance):
        parts = [tag, *shape]
        if transform:
            parts.append(('<transform name="toWorld">', *transform))
        parts.append(material)
        if radiance:
            parts.append(('<emitter type="area">', color("radiance", radiance)))
        self.meshes.append(tuple(parts))

    def text(self):
        comment = "\n".join("     " + line for line in self.purpose.strip().splitlines()).strip()
        body = "".join(_xml(node, 1) for node in [*self.head, *self.meshes])
        return f'<?xml version="1.0"?>\n<!-- {comment}\n     {LICENCE} -->\n<scene>\n{body}</scene>\n'


def _xml(node, depth):
    indent = "    " * depth
    if isinstance(node, str):
        return f"{indent}{node}\n"
    tag = node[0].split()[0].strip("<>")
    return f"{indent}{node[0]}\n" + "".join(_xml(child, depth + 1) for child in node[1:]) + f"{indent}</{tag}>\n"
