"""What make_scenes.py writes: shapes, the Nori XML and OBJ writers, and one module a family of scenes."""
