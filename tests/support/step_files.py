"""STEP files written entity by entity: prisms, balls with a flat, assemblies of parts with names."""

import math

HEAD = """ISO-10303-21;
HEADER;
FILE_DESCRIPTION((''),'2;1');
FILE_NAME('part.step','2026-01-01T00:00:00',(''),(''),'','','');
FILE_SCHEMA(('AUTOMOTIVE_DESIGN { 1 0 10303 214 1 1 1 1 }'));
ENDSEC;
DATA;
"""
UNITS = {
    "mm": "(LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.MILLI.,.METRE.))",
    "cm": "(LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT(.CENTI.,.METRE.))",
    "m": "(LENGTH_UNIT() NAMED_UNIT(*) SI_UNIT($,.METRE.))",
}


class StepFile:
    """Entities of one file in the order in which they are written."""

    def __init__(self, unit="mm"):
        self.lines = []
        self.context = self.add("APPLICATION_CONTEXT('automotive design')")
        self.add(f"APPLICATION_PROTOCOL_DEFINITION('','automotive_design',2000,{self.context})")
        if unit == "in":
            millimetre = self.add(UNITS["mm"])
            measure = self.add(f"LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),{millimetre})")
            exponents = self.add("DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0.)")
            inch = f"(CONVERSION_BASED_UNIT('INCH',{measure}) LENGTH_UNIT() NAMED_UNIT({exponents}))"
        length = self.add(inch if unit == "in" else UNITS[unit])
        angle = self.add("(NAMED_UNIT(*) PLANE_ANGLE_UNIT() SI_UNIT($,.RADIAN.))")
        solid_angle = self.add("(NAMED_UNIT(*) SI_UNIT($,.STERADIAN.) SOLID_ANGLE_UNIT())")
        near = self.add(f"UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-07),{length},'d','')")
        self.space = self.add(
            "(GEOMETRIC_REPRESENTATION_CONTEXT(3) "
            f"GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT(({near})) "
            f"GLOBAL_UNIT_ASSIGNED_CONTEXT(({length},{angle},{solid_angle})) REPRESENTATION_CONTEXT('',''))"
        )

    def add(self, text):
        """The number of one entity, '#7'."""
        self.lines.append(text)
        return f"#{len(self.lines)}"

    def point(self, place):
        """A point."""
        return self.add(f"CARTESIAN_POINT('',({','.join(repr(float(x)) for x in place)}))")

    def direction(self, along):
        """A direction."""
        return self.add(f"DIRECTION('',({','.join(repr(float(x)) for x in along)}))")

    def axes(self, place=(0, 0, 0), along=(0, 0, 1), across=(1, 0, 0)):
        """A place with two of its axes."""
        return self.add(
            f"AXIS2_PLACEMENT_3D('',{self.point(place)},{self.direction(along)},{self.direction(across)})"
        )

    def line(self, start, end, first, last):
        """A straight edge between two vertices."""
        along = [b - a for a, b in zip(start, end)]
        vector = self.add(f"VECTOR('',{self.direction(along)},1.)")
        curve = self.add(f"LINE('',{self.point(start)},{vector})")
        return self.add(f"EDGE_CURVE('',{first},{last},{curve},.T.)")

    def face(self, edges, surface, sense="T", bound="T"):
        """A face bounded by (edge, along it or against it) in one loop."""
        oriented = [self.add(f"ORIENTED_EDGE('',*,*,{edge},.{sense}.)") for edge, sense in edges]
        loop = self.add(f"EDGE_LOOP('',({','.join(oriented)}))")
        outer = self.add(f"FACE_OUTER_BOUND('',{loop},.{bound}.)")
        return self.add(f"ADVANCED_FACE('',({outer}),{surface},.{sense}.)")

    def plane(self, points):
        """The plane of corners that go round its normal."""
        a, b, c = (points[k] for k in (0, 1, 2))
        u, v = ([q - p for p, q in zip(a, other)] for other in (b, c))
        normal = (u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0])
        return self.add(f"PLANE('',{self.axes(a, normal, u)})")

    def prism(self, outline, height, at=(0.0, 0.0, 0.0)):
        """A solid over an outline (x, y) that goes round z and whose first corner is convex."""
        n = len(outline)
        corners = [(x + at[0], y + at[1], z + at[2]) for z in (0.0, height) for x, y in outline]
        vertices = [self.add(f"VERTEX_POINT('',{self.point(corner)})") for corner in corners]
        pairs = [(k, (k + 1) % n) for k in range(n)]
        pairs = pairs + [(a + n, b + n) for a, b in pairs] + [(k, k + n) for k in range(n)]
        edge = {(a, b): self.line(corners[a], corners[b], vertices[a], vertices[b]) for a, b in pairs}

        def side(ring):
            ends = list(zip(ring, [*ring[1:], ring[0]]))
            loop = [(edge[a, b], "T") if (a, b) in edge else (edge[b, a], "F") for a, b in ends]
            return self.face(loop, self.plane([corners[k] for k in ring]))

        caps = [[0, *range(n - 1, 0, -1)], [n + n - 1, *range(n, n + n - 1)]]
        caps[0] = [1, 0, *range(n - 1, 1, -1)]  # both begin about the first corner
        walls = [[k, (k + 1) % n, (k + 1) % n + n, k + n] for k in range(n)]
        shell = self.add(f"CLOSED_SHELL('',({','.join(side(ring) for ring in [*caps, *walls])}))")
        return self.add(f"MANIFOLD_SOLID_BREP('',{shell})")

    def cap(self, radius, floor, sense="T", bound="T"):
        """What is above a height of a ball about the origin, its flat side downwards."""
        rim = math.sqrt(radius**2 - floor**2)
        vertex = self.add(f"VERTEX_POINT('',{self.point((rim, 0, floor))})")
        circle = self.add(f"CIRCLE('',{self.axes((0, 0, floor))},{rim!r})")
        edge = self.add(f"EDGE_CURVE('',{vertex},{vertex},{circle},.T.)")
        ball = self.add(f"SPHERICAL_SURFACE('',{self.axes()},{float(radius)!r})")
        flat = self.add(f"PLANE('',{self.axes((0, 0, floor), (0, 0, -1))})")
        faces = self.face([(edge, "T")], ball, sense, bound), self.face([(edge, "F")], flat)
        return self.add(
            f"MANIFOLD_SOLID_BREP('',{self.add(f'CLOSED_SHELL({chr(39) * 2},({faces[0]},{faces[1]}))')})"
        )

    def product(self, name, solids=()):
        """A part of a name, with its solids; its definition and its shape."""
        mechanical = self.add(f"PRODUCT_CONTEXT('',{self.context},'mechanical')")
        product = self.add(f"PRODUCT('{name}','{name}','',({mechanical}))")
        formation = self.add(f"PRODUCT_DEFINITION_FORMATION('','',{product})")
        design = self.add(f"PRODUCT_DEFINITION_CONTEXT('part definition',{self.context},'design')")
        definition = self.add(f"PRODUCT_DEFINITION('design','',{formation},{design})")
        kind = "ADVANCED_BREP_SHAPE_REPRESENTATION" if solids else "SHAPE_REPRESENTATION"
        shape = self.add(f"{kind}('',({','.join([self.axes(), *solids])}),{self.space})")
        whole = self.add(f"PRODUCT_DEFINITION_SHAPE('','',{definition})")
        self.add(f"SHAPE_DEFINITION_REPRESENTATION({whole},{shape})")
        return definition, shape

    def place(self, assembly, part, at, name=""):
        """Put a part into an assembly, moved."""
        use = self.add(f"NEXT_ASSEMBLY_USAGE_OCCURRENCE('{name}','{name}','',{assembly[0]},{part[0]},$)")
        whole = self.add(f"PRODUCT_DEFINITION_SHAPE('','',{use})")
        moved = self.add(f"ITEM_DEFINED_TRANSFORMATION('','',{self.axes()},{self.axes(at)})")
        relation = self.add(
            f"(REPRESENTATION_RELATIONSHIP('','',{part[1]},{assembly[1]}) "
            f"REPRESENTATION_RELATIONSHIP_WITH_TRANSFORMATION({moved}) SHAPE_REPRESENTATION_RELATIONSHIP())"
        )
        self.add(f"CONTEXT_DEPENDENT_SHAPE_REPRESENTATION({relation},{whole})")

    @property
    def data(self):
        """The bytes of the file."""
        lines = "".join(f"#{k}={text};\n" for k, text in enumerate(self.lines, 1))
        return f"{HEAD}{lines}ENDSEC;\nEND-ISO-10303-21;\n".encode()
