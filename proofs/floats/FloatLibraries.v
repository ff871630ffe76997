(** The same with Flocq's formats and roundings. *)

From Errbound Require Export Libraries.
From Flocq Require Export Core.
