"""Formulas of a case: expressions over its parameters, read by simpleeval. What they may call is the table FUNCTIONS."""

import ast
import functools
import math
import warnings

from simpleeval import EvalWithCompoundTypes, InvalidExpression

from verification.protocol.check import is_number
from verification.protocol.errors import CaseError

FUNCTIONS = {"sqrt": math.sqrt, "exp": math.exp, "log": math.log, "sin": math.sin, "cos": math.cos, "tan": math.tan,
             "radians": math.radians, "min": min, "max": max, "abs": abs, "round": round, "floor": math.floor, "ceil": math.ceil}
CONSTANTS = {"pi": math.pi}
RESERVED = (*FUNCTIONS, *CONSTANTS, "True", "False", "None")
FAILURES = (InvalidExpression, SyntaxError, ArithmeticError, TypeError, ValueError, LookupError, AttributeError)


@functools.cache
def _tree(text: str) -> ast.Expr:
    """Throws SyntaxError."""
    return ast.Expr(ast.parse(text.strip(), mode="eval").body)


def names_in(text: str, where: str) -> set[str]:
    """Names that an expression reads, without functions and constants. Throws CaseError where it is no expression."""
    try:
        nodes = list(ast.walk(_tree(text)))
    except SyntaxError as error:
        raise CaseError(f"{where} = {text!r}: no expression: {error.msg}; mend it") from None
    called = {id(node.func) for node in nodes if isinstance(node, ast.Call)}
    for node in nodes:
        if id(node) in called and (not isinstance(node, ast.Name) or node.id not in FUNCTIONS):
            raise CaseError(f"{where} = {text!r}: {ast.unparse(node)}: no such function; known are {', '.join(FUNCTIONS)}")
    read = {node.id for node in nodes if isinstance(node, ast.Name) and id(node) not in called}
    return read - set(CONSTANTS)


def is_value(value: object) -> bool:
    """What a parameter or a formula may be: a finite number, a text, or a list of such."""
    if isinstance(value, list):
        return all(map(is_value, value))
    return isinstance(value, str) or is_number(value)


def evaluated(text: str, names: dict, where: str):
    """The value of an expression: a number, a text or a list. Throws CaseError."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of nodes that later versions of Python call otherwise
            evaluator = EvalWithCompoundTypes(names=CONSTANTS | names)
        evaluator.functions = FUNCTIONS
        del evaluator.nodes[ast.Attribute]
        value = evaluator.eval(text, previously_parsed=_tree(text))
    except FAILURES as error:
        raise CaseError(f"{where} = {text!r}: {error}; mend the expression") from None
    if not is_value(value):
        raise CaseError(f"{where} = {text!r}: gives {value!r}; write what gives a number, a text or a list of them")
    return value
