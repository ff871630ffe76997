(** Libraries, notations and the scope that files about real numbers import. *)

From Coq Require Export Reals ZArith Lia Lra Psatz Bool List.
Export ListNotations.
Open Scope R_scope.
