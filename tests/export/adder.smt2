; an adder
; sat: a property is violated in one of the clocks 0 to 1. PATH@CLOCK is a net at a clock.
(set-option :produce-models true)
(set-logic QF_BV)

; The same in every clock; what is known of them may be asserted after these lines.
(declare-const m.go (_ BitVec 1))

; Registers before the first edge.
(define-fun init (
    (m.r (_ BitVec 4))
  ) Bool
  (= m.r #b0101))

; Between two edges.
(define-fun settled (
    (m.a (_ BitVec 4))
    (m.r (_ BitVec 4))
    (n3 (_ BitVec 4))
    (m.c (_ BitVec 1))
    (n5 (_ BitVec 4))
  ) Bool
  (and
    (= n3 (bvadd m.r m.a))
    (= m.c ((_ extract 4 4) (bvadd ((_ zero_extend 1) m.r) ((_ zero_extend 1) m.a))))
    (= n5 (ite (= m.go #b1) n3 m.r))))

; At an edge.
(define-fun edge (
    (n5 (_ BitVec 4))
    (m.r+ (_ BitVec 4))
  ) Bool
  (= m.r+ n5))

; A property is violated.
(define-fun violated (
    (m.c (_ BitVec 1))
  ) Bool
  (= m.c #b1) ; never.m.c
  )

; Clock 0.
(declare-const m.a@0 (_ BitVec 4))
(declare-const m.r@0 (_ BitVec 4))
(declare-const n3@0 (_ BitVec 4))
(declare-const m.c@0 (_ BitVec 1))
(declare-const n5@0 (_ BitVec 4))
(assert (init m.r@0))
(assert (settled m.a@0 m.r@0 n3@0 m.c@0 n5@0))

; Clock 1.
(declare-const m.a@1 (_ BitVec 4))
(declare-const m.r@1 (_ BitVec 4))
(declare-const n3@1 (_ BitVec 4))
(declare-const m.c@1 (_ BitVec 1))
(declare-const n5@1 (_ BitVec 4))
(assert (edge n5@0 m.r@1))
(assert (settled m.a@1 m.r@1 n3@1 m.c@1 n5@1))

; The question.
(assert (or (violated m.c@0) (violated m.c@1)))
(check-sat)
