#!/usr/bin/env python3
"""Checks the sizes of sources, functions and classes.

usage: sizes.py [--list] ROOT FOLDER...

Limits: 450 lines in a source, 90 lines in a function (from its signature to its last brace), 20 public members in a
class of C++ (functions and data; constructors, destructors, assignments, static create() functions, aliases and nested
types do not count, nor do the structures that shaders share). Understands C++ and GLSL as clang-format lays them out.
--list prints the largest of each kind instead.
"""
import os
import re
import sys

MAX_SOURCE_LINES = 450
MAX_FUNCTION_LINES = 90
MAX_PUBLIC_MEMBERS = 20
ENDINGS = (".c", ".cpp", ".hpp", ".h", ".inl", ".glsl", ".comp", ".vert", ".frag")
TOKEN = re.compile(r'//[^\n]*|/\*.*?\*/|R"(\w*)\(.*?\)\1"|"(?:[^"\\\n]|\\.)*"|\'(?:[^\'\\\n]|\\.)+\'', re.S)


def without_comments_and_strings(text):
    """Blanks comments, strings and preprocessor lines; lengths and line ends stay."""
    def blank(match):
        token = match.group(0)
        # A quote after a letter or digit separates digits (1'000), so it does not begin a character literal.
        if token[0] == "'" and match.start() > 0 and text[match.start() - 1].isalnum():
            return token
        return re.sub(r"[^\n]", " ", token)
    text = TOKEN.sub(blank, text)
    lines = text.split("\n")
    continued = False
    for i, line in enumerate(lines):
        if continued or line.lstrip().startswith("#"):
            continued = line.endswith("\\")
            lines[i] = ""
        else:
            continued = False
    return "\n".join(lines)


class Scope:
    def __init__(self, kind, name, line, access):
        self.kind, self.name, self.line, self.access = kind, name, line, access
        self.members = 0


def member_counts(declaration):
    """Returns whether the text of one declaration in a class is a member that counts towards the limit."""
    text = re.sub(r"\[\[[^\]]*\]\]", "", declaration).strip()
    if not text or re.match(r"(using|friend|static_assert|typedef|template\s*<[^>]*>\s*(class|struct|friend)|enum|union"
                            r"|(class|struct)\s+\w+\s*$)\b", text):
        return False
    if re.match(r"(class|struct)\s+\w+\s*$", text):
        return False
    if "operator=" in text.replace(" ", "") and "operator==" not in text.replace(" ", ""):
        return False
    return True


def is_special(declaration, name):
    text = re.sub(r"\[\[[^\]]*\]\]", "", declaration).strip()
    if re.match(r"static\s.*\bcreate\s*\(", text, re.S):
        return True
    return re.match(r"(explicit\s+|constexpr\s+|virtual\s+|inline\s+)*~?" + re.escape(name) + r"\s*\(", text) is not None


def scan(text):
    """Yields (kind, name, first line, size) of functions and classes."""
    clean = without_comments_and_strings(text)
    stack = []
    begun = 0       # start of the current declaration
    depth = 0       # number of open parentheses
    i = 0
    found = []
    line_of = [0]
    for ch in clean:
        line_of.append(line_of[-1] + (ch == "\n"))

    def count_member(declaration):
        scope = stack[-1] if stack else None
        if scope and scope.kind == "class" and scope.access == "public":
            if member_counts(declaration) and not is_special(declaration, scope.name):
                # Several variables may share a declaration.
                body = re.sub(r"[({<].*", "", declaration, flags=re.S)
                scope.members += 1 + (body.count(",") if "(" not in declaration else 0)

    while i < len(clean):
        ch = clean[i]
        if ch in "([":
            depth += 1
        elif ch in ")]":
            depth -= 1
        elif depth == 0 and ch == "{":
            head = clean[begun:i].strip()
            outer = stack[-1].kind if stack else "namespace"
            head = re.sub(r"^((public|private|protected)\s*:\s*)+", "", head)
            line = line_of[begun + len(clean[begun:i]) - len(clean[begun:i].lstrip())] + 1
            plain = re.sub(r"\[\[[^\]]*\]\]", "", head)
            kind, name = "block", ""
            if outer in ("namespace", "class"):
                typed = re.match(r"(?:template\s*<.*?>\s*)?(class|struct|union)\s+(?:\w+\s+)*?(\w+)(?:\s+final)?\s*(?::[^:].*)?$",
                                 plain, re.S)
                if re.match(r"(inline\s+)?namespace\b", plain) or plain.startswith("extern"):
                    kind = "namespace"
                elif typed:
                    kind, name = "class", typed.group(2)
                elif "(" in plain and not re.search(r"=\s*$", re.sub(r"operator\s*=+\s*", "", plain)) and \
                        not re.match(r"(constexpr|const|static|inline|\s)*[\w:<>,\s*&]+=", plain):
                    kind = "function"
                    call = re.search(r"([\w~:]+|operator\s*\S+)\s*\(", plain)
                    name = call.group(1) if call else plain
                elif re.match(r"enum\b", plain):
                    kind = "enum"
            # The braces of a member initialiser are not the body of the function.
            if kind == "function" and re.search(r"\)\s*(noexcept\s*)?:(?!:).*[\w>]$", plain, re.S) and \
                    not re.search(r"[)}]$", plain):
                kind = "initialiser"
            access = "public" if kind == "class" and re.search(r"\bstruct\b|\bunion\b", plain) else "private"
            if outer == "class" and kind in ("function", "block"):
                count_member(head)
            scope = Scope(kind, name, line, access)
            scope.begun = begun
            stack.append(scope)
            if kind != "initialiser":
                begun = i + 1
        elif depth == 0 and ch == "}" and stack:
            scope = stack.pop()
            if scope.kind == "function":
                found.append(("function", scope.name, scope.line, line_of[i] + 1 - scope.line + 1))
            elif scope.kind == "class":
                found.append(("class", scope.name, scope.line, scope.members))
            if scope.kind == "initialiser":
                begun = scope.begun
            else:
                begun = i + 1
                if scope.kind in ("block", "class", "enum"):
                    # The rest up to the semicolon belongs to the declaration that has already been counted.
                    rest = re.match(r"[^;{}()]*;", clean[i + 1:])
                    if rest and scope.kind != "class":
                        i += rest.end()
                        begun = i + 1
        elif depth == 0 and ch == ";":
            declaration = re.sub(r"^\s*((public|private|protected)\s*:\s*)+", "", clean[begun:i])
            count_member(declaration.strip())
            begun = i + 1
        elif depth == 0 and ch == ":" and stack and stack[-1].kind == "class":
            label = re.search(r"\b(public|private|protected)\s*$", clean[begun:i])
            if label and clean[i + 1] != ":":
                stack[-1].access = label.group(1)
                begun = i + 1
        i += 1
    return found


def main():
    arguments = [a for a in sys.argv[1:] if a != "--list"]
    root, folders = arguments[0], arguments[1:]
    rows = []
    for folder in folders:
        for at, _, names in os.walk(os.path.join(root, folder)):
            for name in sorted(names):
                if not name.endswith(ENDINGS):
                    continue
                path = os.path.join(at, name)
                with open(path, encoding="utf-8") as file:
                    text = file.read()
                shown = os.path.relpath(path, root)
                rows.append(("source", "", shown, 1, text.count("\n")))
                is_cpp = name.endswith((".cpp", ".hpp"))
                rows += [(kind, what, shown, line, size) for kind, what, line, size in scan(text)
                         if kind != "class" or is_cpp]
    limits = {"source": MAX_SOURCE_LINES, "function": MAX_FUNCTION_LINES, "class": MAX_PUBLIC_MEMBERS}
    units = {"source": "lines", "function": "lines", "class": "public members"}
    if "--list" in sys.argv:
        for kind in limits:
            for row in sorted((r for r in rows if r[0] == kind), key=lambda r: -r[4])[:25]:
                print(f"{row[4]:5} {units[kind]}: {row[2]}:{row[3]} {row[1]}")
        return 0
    functions = sum(1 for row in rows if row[0] == "function")
    bad = [row for row in rows if row[4] > limits[row[0]]]
    for kind, what, path, line, size in bad:
        print(f"{path}:{line}: {kind} {what} has {size} {units[kind]}; at most {limits[kind]} are allowed")
    print(f"{len(rows)} sources, functions and classes, {functions} of them functions; {len(bad)} are too large")
    return 1 if bad or functions == 0 else 0


if __name__ == "__main__":
    sys.exit(main())
