"""The functions that decide, and those that are tied: their results on some inputs are compared with those of the
proofs' definitions (README.md, The tie). README.md lists the others with the reasons."""
import re
import sys
from pathlib import Path

proofs = Path(__file__).resolve().parent
root = proofs.parent
sys.path.insert(0, str(root / "tests/project"))
from layout_test import code_alone, cpp_functions  # noqa: E402

# For each tie, the files whose functions it compares, and the beginnings of its lines in tie.txt.
TIES = {
    "rules": (["include/errbound/rules/affine.hpp", "include/errbound/rules/interval.hpp",
               "include/errbound/rules/none.hpp", "include/errbound/rules/relative.hpp",
               "include/errbound/rules/residual.hpp", "include/errbound/rules/safe.hpp",
               "include/errbound/rules/sharp.hpp", "include/errbound/rules/tight.hpp",
               "include/errbound/error_free.hpp", "include/errbound/functions.hpp",
               "include/errbound/detail/running_bound.hpp", "include/errbound/detail/sum_of_bounds.hpp",
               "include/errbound/tracked.hpp",
               "include/errbound/integers/fixed_integer.hpp"],
              ("tiny_float", "float", "double", "fixed_integer")),
    "symbols": (["include/errbound/sign.hpp", "include/errbound/bernstein.hpp", "include/errbound/bsc.hpp",
                 "include/ccd/methods/forms.hpp", "include/errbound/predicates.hpp"], ("symbol",)),
    "integers": (["ccd/exact/axis_units.hpp", "ccd/exact/bounded_integer.hpp", "ccd/exact/close_contact.hpp",
                  "ccd/exact/common_roots.hpp", "ccd/exact/cubic_roots.hpp", "ccd/exact/features.hpp",
                  "ccd/exact/integer_decision.hpp", "ccd/exact/integers.cpp",
                  "ccd/exact/interior_contact.hpp", "ccd/exact/vertex_edge_contact.hpp"], ("integers",)),
    "floats": (["ccd/exact/static_filter/coefficient_signs.hpp", "ccd/exact/static_filter/constants.hpp",
                "ccd/exact/static_filter/difference_extents.hpp",
                "ccd/exact/static_filter/separating_axes.hpp", "ccd/exact/static_filter/subdivision.hpp",
                "ccd/exact/static_filter/whole_step.hpp", "ccd/exact/stages.cpp",
                "ccd/batch/rounded_axes.hpp", "include/errbound/roots/control_values.hpp",
                "include/errbound/filters/error_count.hpp"], ("filter", "rounded_axes")),
    "roots": (["include/errbound/roots/descartes_search.hpp", "include/errbound/roots/fixed_row.hpp",
               "include/errbound/roots/integer_polynomial.hpp", "include/errbound/roots/local_form.hpp",
               "include/errbound/roots/prime_field.hpp", "include/errbound/roots/root_isolation.hpp",
               "include/errbound/roots/sign_variations.hpp", "include/errbound/integers/dyadic.hpp"], ("roots",)),
    "times": (["ccd/contact/integer_first_contact.hpp", "ccd/contact/integer_times.cpp", "ccd/contact/interior_time.hpp",
               "ccd/contact/time_bracket.hpp", "ccd/contact/vertex_edge_time.hpp"], ("times",)),
    "words": (["include/errbound/integers/long_integer.hpp"], ("long_integer",)),
    "filters": (["include/errbound/filters/static_filter.hpp", "include/errbound/filters/semi_static_filter.hpp"],
                ("expression",)),
}
# Other files with functions that decide.
OTHERS = ["include/errbound/elementary.hpp", "include/errbound/functions/angle_reduction.hpp",
          "include/errbound/functions/function_error.hpp",
          "include/errbound/functions/function_of_range.hpp", "include/errbound/roots/double_order.hpp",
          "include/errbound/roots/floating_roots.hpp", "include/errbound/roots/nearby_value.hpp",
          "include/errbound/roots/polynomial_stages.hpp",
          "include/errbound/roots/real_roots.hpp", "include/errbound/roots/root_filter.hpp",
          "include/errbound/filters/expression_count.hpp", "include/errbound/filters/predicate_stages.hpp",
          "include/errbound/integers/binary_double.hpp", "include/errbound/integers/common_exponent.hpp",
          "include/errbound/integers/double_word.hpp", "include/errbound/integers/integer.hpp",
          "include/errbound/integers/magnitudes.hpp", "include/errbound/integers/sized_integer.hpp",
          "include/errbound/predicate.hpp", "include/errbound/simplices/relation.hpp",
          "ccd/exact/coordinate_axes.hpp", "ccd/exact/exact.cpp",
          "ccd/exact/reference.cpp", "ccd/exact/unbounded_integers.hpp",
          "ccd/exact/static_filter/distance_margins.hpp", "ccd/contact/condition.cpp",
          "ccd/contact/control_polynomial.hpp", "ccd/contact/curve_filter.cpp",
          "ccd/contact/feature_conditions.hpp", "ccd/contact/reference.cpp", "ccd/contact/separation.cpp",
          "ccd/contact/separation_filter.hpp", "ccd/contact/time_of_impact.cpp",
          "ccd/contact/time_polynomial.hpp", "ccd/batch/filter_stages.hpp", "ccd/batch/pack_subdivision.hpp",
          "ccd/batch/rounded_positions.hpp", "ccd/batch/time_stage.hpp", "ccd/batch/twofold.hpp",
          "ccd/step/box_tree.hpp", "ccd/step/search_kernels.cpp", "ccd/step/swept_boxes.hpp",
          "include/ccd/methods/bsc.hpp", "ccd/methods/bsc_exact.cpp", "ccd/exact/finite.hpp", "ccd/contact/curves.cpp",
          "ccd/contact/first_times.cpp", "ccd/contact/data/contact_data.cpp", "ccd/cuda/exact_stages.hpp",
          "ccd/cuda/packet_search.hpp"]


def functions(path):
    """Yields (name, first line, number of lines) for every function of a file."""
    text = (root / path).read_text()
    for _, first, lines in cpp_functions(text):
        head = "\n".join(text.split("\n")[first - 1:first - 1 + lines]).split("{")[0]
        head = re.sub(r"\((min|max)\)\(", r" \1(", head)  # in parentheses because of macros of these names
        names = [name for name in re.findall(r"(operator\s*\(\)|operator[^\s(]+|[~\w]+|\])\s*\(", head)
                 if name not in ("requires", "decltype", "noexcept", "explicit")]
        name = names[0] if names else head.split()[0]
        if name == "]":  # the variable of a lambda
            name = re.search(r"(\w+)\s*=[^=]*\[", head)[1]
        yield name, first, lines


def untied():
    """Returns the names of untied functions by file, from README.md."""
    found = {}
    text = (proofs / "README.md").read_text().split("### Functions without a tie\n")[1].split("\n## ")[0]
    rows = re.findall(r"^\| `([\w/.]+)` \| (`[^|]+`) \| [^|]+ \|$", text, re.MULTILINE)
    for path, names in rows:
        found[path] = set(re.findall(r"`([^`]+)`", names))
    return found


def untied_functions(path):
    """Returns (first line, number of lines) for the untied functions of a tied file."""
    names = untied().get(path, set())
    return [(first, lines) for name, first, lines in functions(path) if name in names]


def count():
    """Returns the number of compared functions by tie, and the number of others. Raises ValueError if README.md names
    functions that do not exist, or lacks one."""
    named, tied, others = untied(), {}, 0
    for tie, (paths, _) in TIES.items():
        tied[tie] = 0
        for path in paths:
            names = [name for name, _, _ in functions(path)]
            left = named.pop(path, set())
            if not left <= set(names):
                raise ValueError(f"README.md names functions of {path} as not tied: {left}; it has {names}")
            tied[tie] += sum(name not in left for name in names)
            others += sum(name in left for name in names)
    for path in OTHERS:
        names = [name for name, _, _ in functions(path)]
        if named.pop(path, set()) != set(names):
            row = ", ".join(f"`{name}`" for name in dict.fromkeys(names))
            raise ValueError(f"README.md must name the functions of {path}, which is not tied: {row}")
        others += len(names)
    if named:
        raise ValueError(f"README.md names functions as not tied in files that decide nothing: {sorted(named)}")
    listed = {path for paths, _ in TIES.values() for path in paths} | set(OTHERS)
    for path in (path for folder in ("include", "ccd") for path in sorted((root / folder).rglob("*.[hc]pp"))):
        name = str(path.relative_to(root))
        if name not in listed and re.search(r"proofs/\w+\.v", path.read_text()) and any(functions(name)):
            raise ValueError(f"{name} names theorems, and ties.py does not list it")
    return tied, others


def cases():
    """Returns the number of inputs in tie.txt by tie."""
    found = dict.fromkeys(TIES, 0)
    for line in (proofs / "tie.txt").read_text().splitlines():
        start, _, number, _ = line.split()
        tie = next(tie for tie, (_, starts) in TIES.items() if re.match(r"\w+", start)[0] in starts)
        found[tie] += int(number)
    return found
