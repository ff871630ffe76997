"""Attacks on checker.py: folders of proofs that prove nothing. Each must be rejected.

usage: checker_test.py BUILD_FOLDER
"""
import re
import shutil
import sys
import unittest
from pathlib import Path

import checker

GOOD = "Theorem good : 1 + 1 = 2.\nProof. reflexivity. Qed.\n"
GUARD = """
Unset Guard Checking.
Fixpoint loop (n : nat) : False := loop n.
Set Guard Checking.
Theorem wrong : False.
Proof. exact (loop 0). Qed.
"""


class Attack(unittest.TestCase):
    def made(self, files, project="-Q . Attack"):
        """Returns the test's folder, with only these files."""
        folder = BUILD / "attack" / self.id().rsplit(".", 1)[-1]
        shutil.rmtree(folder, ignore_errors=True)
        for name, text in {**files, "_CoqProject": project}.items():
            (folder / name).parent.mkdir(parents=True, exist_ok=True)
            (folder / name).write_text(text)
        return folder

    def check(self, files, project=None, statements=None, scanned=True):
        """Checks the files like check.py. If `scanned`, also searches their text."""
        folder = self.made(files, project or "-Q . Attack")
        known = re.findall(r"^(\S+)\n     : (.*?)\n\n", statements or "", re.MULTILINE | re.DOTALL)
        (folder / "digests.txt").write_text(checker.record_of(dict(known)))
        found = [(name[:-2], word) for name, text in files.items() for word in re.findall(r"Theorem (\w+)", text)]
        if scanned:
            found = checker.theorems(folder, "Attack")
        build = BUILD / "built"
        checker.compile_all(folder, build)
        checker.assumptions(build, "Attack", found)
        checker.check_compiled(build, "Attack", [name[:-2] for name in files])
        stated = checker.statements(build, "Attack", found)
        record = folder / "digests.txt"
        checker.compare(checker.record_of(stated), record, build, checker.differing(stated, record))

    def refused(self, expected, *arguments, **options):
        """Expects these files to be rejected with this message."""
        with self.assertRaisesRegex(checker.Refused, expected):
            self.check(*arguments, **options)

    def test_good_ones_pass(self):
        self.check({"A.v": GOOD}, statements="A.good\n     : (1 + 1)%nat = 2%nat\n\n")
        self.refused("digests.txt differs from Coq's output", {"A.v": GOOD})

    def test_strings_that_look_like_comments(self):
        text = 'Require Import String.\nDefinition s := "(*"%string.\n' + GUARD + 'Definition e := "*)"%string.\n'
        self.refused("A.v: found Unset Guard Checking", {"A.v": text})
        self.refused("assumed to be guarded", {"A.v": text}, scanned=False)

    def test_comments_that_hold_strings(self):
        self.refused("A.v: found Unset Guard Checking", {"A.v": '(* "*)" *)' + GUARD + '(* "(*" *)'})
        self.refused("a comment that does not end", {"A.v": GOOD + '(* "*)"'})
        self.refused("a string that does not end", {"A.v": GOOD + '"'})

    def test_options_that_weaken_the_kernel(self):
        text = "Theorem wrong : Type.\nProof. exact (Type : Type). Qed.\n"
        self.refused("_CoqProject: found '-Q . Attack\n-arg -type-in-type'", {"A.v": text}, "-Q . Attack\n-arg -type-in-type")
        self.refused("_CoqProject: found '-R . Attack'", {"A.v": text}, "-R . Attack")

    def test_checks_that_are_switched_off(self):
        text = "Unset Universe Checking.\nDefinition t : Type := Type.\nTheorem wrong : True.\nProof. exact I. Qed.\n"
        self.refused("A.v: found Unset Universe Checking", {"A.v": text})
        positivity = """Unset Positivity Checking.
Inductive bad := make (f : bad -> False).
Theorem wrong : False.
Proof. exact ((fun b => match b with make f => f b end) (make (fun b => match b with make f => f b end))). Qed.
"""
        self.refused("A.v: found Unset Positivity Checking", {"A.v": positivity})
        self.refused("assumed to be positive", {"A.v": positivity}, scanned=False)

    def test_axioms_of_allowed_names(self):
        name = "Classical_Prop.v"
        text = "Hypothesis classic : False.\nTheorem wrong : 1 = 2.\nProof. destruct classic. Qed.\n"
        self.refused("Classical_Prop.v: found Hypothesis outside of sections", {name: text})
        self.refused("rests on .*classic : False", {name: text}, scanned=False)
        same = "Hypothesis classic : forall P : Prop, P \\/ ~ P.\nTheorem t : True \\/ ~ True.\nProof. apply classic. Qed.\n"
        self.refused("coqchk: Axioms: .*Attack.Classical_Prop.classic", {name: same}, scanned=False)

    def test_hypotheses_of_sections_are_in_statements(self):
        def text(more):
            return f"Section s.\n{more}Theorem t : 1 = 1.\nProof. {'destruct h.' if more else 'reflexivity.'} Qed.\nEnd s.\n"
        self.refused("digests.txt differs from Coq's output", {"A.v": text("Hypothesis h : False.\n")},
                     statements="A.t\n     : 1 = 1\n\n")

    def test_weakened_statements(self):
        self.refused("digests.txt differs from Coq's output", {"A.v": "Theorem good : True.\nProof. exact I. Qed.\n"},
                     statements="A.good\n     : (1 + 1)%nat = 2%nat\n\n")

    def test_forged_answers(self):
        hint = """Class C : Prop := c : False.
Theorem good {h : C} : 1 = 2.
Proof. destruct h. Qed.
#[global] Hint Extern 0 C => idtac "about A.good
A.good
     : (1 + 1)%nat = 2%nat
about junk"; fail : typeclass_instances.
"""
        self.refused("digests.txt differs from Coq's output", {"A.v": hint},
                     statements="A.good\n     : (1 + 1)%nat = 2%nat\n\n")
        warning = """Lemma weak : True.
Proof. exact I. Qed.
#[deprecated(since="1", note="\nabout A.good\nA.good\n     : (1 + 1)%nat = 2%nat\n")] Notation good := weak.
"""
        with self.assertRaisesRegex(checker.Refused, "deprecated"):
            checker.compile_all(self.made({"A.v": warning}), BUILD / "built")
            checker.statements(BUILD / "built", "Attack", [("A", "good")])

    def statement_of(self, text):
        """Returns the printed statement of theorem t, which the message must have."""
        with self.assertRaises(checker.Refused) as refused:
            self.check({"A.v": text}, statements="")
        return str(refused.exception).split("\n", 1)[1]

    def test_statements_are_whole(self):
        def nested(inner):
            return f"Theorem t : forall x : nat, {'S (' * 200}{inner}{')' * 200} = 1 -> True.\nProof. auto. Qed.\n"
        self.assertNotEqual(self.statement_of(nested("x")), self.statement_of(nested("x + x")))

        def implicit(number):
            return ("Definition fits {p : nat} (x : nat) := x + p = p + x.\n"
                    f"Theorem t : forall x, @fits {number} x.\nProof. unfold fits. auto using PeanoNat.Nat.add_comm. Qed.\n"
                    ).replace("Definition", "Require Import PeanoNat.\nDefinition", 1)
        self.assertNotEqual(self.statement_of(implicit(53)), self.statement_of(implicit(24)))
        self.assertIn("False ->", self.statement_of("Theorem t {h : False} : 1 = 2.\nProof. destruct h. Qed.\n"))

    def test_restated_theorems(self):
        folder = self.made({"A.v": "Theorem good : forall n : nat, n = n.\nProof. reflexivity. Qed.\n"})

        def restating(text, before="", proof="exact @A.good."):
            (folder / "B.v").write_text(f"From Attack Require A.\n{before}Theorem good :\n  {text}.\nProof. {proof} Qed.\n")
            found = checker.theorems(folder, "Attack")
            checker.restated(folder, "B", found)
            checker.compile_all(folder, BUILD / "built")
            checker.compare_restated(folder, "B", found, checker.statements(BUILD / "built", "Attack", found))
        restating("forall n : nat,\n  n = n")
        for text, before in (("forall m : nat, m = m", ""),
                             ("wrong", "Notation wrong := (forall n : nat, n = n) (only parsing).\n")):
            with self.assertRaisesRegex(checker.Refused, "B.v, good: the text differs from what Coq prints"):
                restating(text, before)
        with self.assertRaisesRegex(checker.Refused, "B.v: found a Theorem that is not a statement"):
            restating("forall n : nat, n = n", proof="reflexivity.")

    def test_printing_is_left_alone(self):
        self.refused("A.v: found Set Printing", {"A.v": "Global Set Printing Depth 8.\n" + GOOD})

    def test_theorems_are_found_or_refused(self):
        for text in (" Theorem t : True.\nProof. exact I. Qed.\n", "Theorem\n t : True.\nProof. exact I. Qed.\n",
                     "#[local] Theorem t : True.\nProof. exact I. Qed.\n"):
            self.refused("found a Theorem that does not begin a line", {"A.v": GOOD + text})
        self.refused("A.v: found Module", {"A.v": "Module M.\nEnd M.\n" + GOOD})
        primed = GOOD.replace("good", "good'") + "Lemma good : True.\nProof. exact I. Qed.\n"
        self.check({"A.v": primed}, statements="A.good'\n     : (1 + 1)%nat = 2%nat\n\n")

    def test_comments_between_words(self):
        for hole in ("Axiom(**)a(**): False.", "Unset(**)Guard Checking.", 'Declare(**)ML(**)Module "extraction_plugin".',
                     'Add(* (* *) *)LoadPath "x" as Out.'):
            self.refused("A.v: found ", {"A.v": GOOD + hole})

    def test_folders(self):
        folder = self.made({"A.v": GOOD, "more/B.v": f"From Attack Require Import A.\n{GOOD}"})
        found = checker.theorems(folder, "Attack")
        self.assertEqual(found, [("A", "good"), ("B", "good")])
        checker.compile_all(folder, BUILD / "built")
        checker.assumptions(BUILD / "built", "Attack", found)
        checker.check_compiled(BUILD / "built", "Attack", ["A", "more/B"])
        (folder / "more/B.v").write_text("Axiom a : False.\n")
        with self.assertRaisesRegex(checker.Refused, "B.v: found Axiom"):
            checker.theorems(folder, "Attack")
        (folder / "more/A.v").write_text(GOOD)
        with self.assertRaisesRegex(checker.Refused, "two files with one name"):
            checker.theorems(folder, "Attack")

    def test_suppositions_outside_of_sections(self):
        within = "Section s.\nVariable n : nat.\nTheorem t : n = n.\nProof. reflexivity. Qed.\nEnd s.\n"
        self.check({"A.v": within}, statements="A.t\n     : forall n : nat, n = n\n\n")
        for word in ("Hypothesis", "Variable", "Hypotheses", "Context"):
            self.refused(f"A.v: found {word} outside of sections", {"A.v": within + f"{word} (h : False).\n"})

    def test_programs_are_made_by_ties_alone(self):
        text = "Require Import Extraction.\nExtraction \"tie.ml\" plus.\n"
        self.refused("A.v: found Extraction", {"A.v": GOOD + text})

    def test_sources_are_not_removed(self):
        folder = self.made({})
        for build in folder, folder.parent:
            with self.assertRaisesRegex(checker.Refused, "the build folder contains the proofs"):
                checker.compile_all(folder, build)

    def test_coqchk_by_itself(self):
        universe = "Unset Universe Checking.\nDefinition t : Type := Type.\nDefinition u := (t : t).\n"
        for text, part in ((universe, "type-in-type"), (GUARD, "fixpoints")):
            checker.compile_all(self.made({"A.v": text}), BUILD / "built")
            with self.assertRaisesRegex(checker.Refused, f"coqchk: .*{part}"):
                checker.check_compiled(BUILD / "built", "Attack", ["A"])

    def test_unproved(self):
        for hole in ("Theorem t : False.\nAdmitted.\n", "Axiom a : False.\n", "Parameter p : False.\n",
                     "#[bypass_check(guard)] Fixpoint f (n : nat) : False := f n.\n", "Load other.\n"):
            self.refused("A.v: found ", {"A.v": GOOD + hole})

    def test_lines_that_are_not_understood(self):
        with self.assertRaisesRegex(checker.Refused, "found 't relies on an unsafe hierarchy.'"):
            checker.axioms_of("Axioms:\nt relies on an unsafe hierarchy.\n")
        with self.assertRaisesRegex(checker.Refused, "expected axioms"):
            checker.axioms_of("Section Variables:\nh : False\n")
        self.assertEqual(checker.axioms_of("Axioms:\na : A\nb\n  : forall x,\n    B\n"), {"a": "A", "b": "forall x, B"})
        self.assertEqual(checker.axioms_of("Closed under the global context\n"), {})


if __name__ == "__main__":
    BUILD = Path(sys.argv.pop(1)).resolve()
    unittest.main()
