"""What every clustering nodelet can be tuned by, whatever its algorithm (PipelineConfig in pipeline/frame_pipeline.h)."""
from dynamic_reconfigure.parameter_generator_catkin import ParameterGenerator, bool_t, double_t, int_t, str_t

PACKAGE = "lidar_panoptic_clustering"


def pipeline_parameters():
    """A generator that holds the pipeline's parameters; an algorithm's .cfg adds its own."""
    generator = ParameterGenerator()
    policies = generator.enum([
        generator.const("SameClass", str_t, "class", "Points of one class only"),
        generator.const("SameGroup", str_t, "group", "Points of classes of one group of the class table"),
        generator.const("AnyClass", str_t, "any", "Points of all thing classes"),
    ], "Which points may share an instance")
    generator.add("max_range_m", double_t, 0, "Returns beyond this range count as no return [m]", 300.0, 1.0, 10000.0)
    views = generator.enum([
        generator.const("Auto", str_t, "auto", "Told from each scan"),
        generator.const("FullTurn", str_t, "full_turn", "The first column follows the last"),
        generator.const("Sector", str_t, "sector", "The scan does not close on itself"),
    ], "Field of view")
    generator.add("field_of_view", str_t, 0, "Whether the scan closes on itself", "auto", edit_method=views)
    generator.add("class_policy", str_t, 0, "Which points may share an instance", "class", edit_method=policies)
    generator.add("link_distance_scale", double_t, 0, "Factor on the class table's link distances", 1.0, 0.05, 100.0)
    generator.add("bridge_distance_m", double_t, 0,
                  "Objects of one group of classes that are closer are one; 0: never, else from 0.001 [m]",
                  0.3, 0.0, 10.0)
    generator.add("split", bool_t, 0, "Objects too big for their class are cut where they hang together least", True)
    generator.add("size_margin", double_t, 0, "Factor on the class's usual size above which an object is too big",
                  1.3, 1.0, 10.0)
    generator.add("merge", bool_t, 0, "Parts that together still fit one object of their class are joined", True)
    generator.add("vote", bool_t, 0, "All points of an instance get the class of most of them", True)
    generator.add("min_points", int_t, 0, "Smaller instances get id 0; 1 keeps all [points]", 1, 1, 10000)
    return generator
