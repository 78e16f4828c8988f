"""Reads from the sources in nodes/ what a program offers: parameters, topics, services, actions, options."""
import functools
import math
import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parent.parent
NODES = ROOT / "nodes"
KINDS = ("integer", "number", "flag", "text", "frame", "choice", "vector", "texts")  # ros/parameters.hpp
INCLUDE = re.compile(r'^\s*#\s*include\s*"([^"]+)"', re.M)


def without_comments(text):
    """Of C++: comments are blanks, texts in quotes stay."""
    return re.sub(r'"(?:\\.|[^"\\])*"|//[^\n]*|/\*.*?\*/', lambda m: m[0] if m[0][0] == '"' else " ", text, flags=re.S)


@functools.lru_cache(maxsize=None)
def source(file):
    return without_comments((NODES / file).read_text(encoding="utf-8"))


@functools.lru_cache(maxsize=None)
def all_sources():
    return [path.relative_to(NODES).as_posix() for path in sorted(NODES.glob("**/*")) if path.suffix in (".cpp", ".hpp")]


def closing(text, start):
    """Where the bracket that opens at `start` closes."""
    pairs, depth, quoted = {"(": ")", "[": "]", "{": "}"}, [], False
    for at in range(start, len(text)):
        sign = text[at]
        if sign == '"' and text[at - 1] != "\\":
            quoted = not quoted
        if quoted:
            continue
        if sign in pairs:
            depth.append(pairs[sign])
        elif depth and sign == depth[-1]:
            depth.pop()
            if not depth:
                return at
    raise ValueError("a bracket does not close: " + text[start:start + 80])


def split_at_commas(text):
    parts, at = [""], 0
    while at < len(text):
        if text[at] in "([{":
            end = closing(text, at)
            parts[-1] += text[at:end + 1]
            at = end + 1
        elif text[at] == '"':
            end = re.compile(r'"(?:\\.|[^"\\])*"').match(text, at).end()
            parts[-1] += text[at:end]
            at = end
        else:
            if text[at] == ",":
                parts.append("")
            else:
                parts[-1] += text[at]
            at += 1
    return [" ".join(part.split()) for part in parts]


def calls(text, name):
    """The arguments of each call of what the regular expression `name` matches, with the match."""
    for match in re.finditer(rf"(?:{name})\s*(?:<[^<>()]*>)?\s*\(", text):
        yield match, split_at_commas(text[match.end():closing(text, match.end() - 1)])


def text_in(expression):
    match = re.fullmatch(r'"((?:\\.|[^"\\])*)"', expression.strip())
    return match[1] if match else None


# --- which files make up a node

@functools.lru_cache(maxsize=None)
def files_of(main):
    """The files that a program's main file draws in: headers by its includes, and each header's own source."""
    found, left = set(), [main]
    while left:
        file = left.pop()
        if file in found or not (NODES / file).is_file():
            continue
        found.add(file)
        left += INCLUDE.findall((NODES / file).read_text(encoding="utf-8"))
        if file.endswith(".hpp"):
            left.append(file[:-4] + ".cpp")
    return sorted(found)


def nodes():
    """Name of each node: its main file."""
    return {pathlib.PurePath(file).name[:-len("_node.cpp")]: file for file in all_sources() if file.endswith("_node.cpp")}


# --- values that stand behind names

def declared(type_name, user):
    """Body and file of a struct of that name, that of `user`'s own namespace first."""
    *spaces, name = type_name.split("::")
    found = []
    for file in all_sources():
        text = source(file)
        for match in re.finditer(rf"\b(?:struct|class)\s+{name}\b[^;{{()]*\{{", text):
            space = re.findall(r"namespace tensegric_fit(?:::(\w+))?\s*\{", text[:match.start()]) or [""]
            outer = bool(spaces) and re.search(rf"\b(?:struct|class)\s+{spaces[-1]}\b[^;{{()]*\{{", text[:match.start()])
            near = 4 * bool(outer) + 2 * (file[:-4] == user[:-4]) + (spaces[-1:] == space[-1:])
            found.append((near, file, text[match.end():closing(text, match.end() - 1)]))
    return max(found, default=(0, None, ""), key=lambda entry: entry[0])


def statements(body):
    """Of a struct's body, without the bodies of its functions."""
    at, statement = 0, ""
    while at < len(body):
        if body[at] == "{":
            end = closing(body, at)
            if re.search(r"\)\s*(const|noexcept|override|\s)*$", statement):
                statement = ""
            else:
                statement += body[at:end + 1]
            at = end
        elif body[at] == ";":
            yield " ".join(statement.split())
            statement = ""
        else:
            statement += body[at]
        at += 1


def member(body, name):
    """Type of a member, and what it begins as."""
    for statement in statements(body):
        match = re.match(r"(?:public:|private:)?\s*(?:(?:const|static|constexpr|inline)\s+)*([\w:]+(?:<.*?>)?)[\s&]+(\w.*)$",
                         statement)
        for part in split_at_commas(match[2]) if match else []:
            word = re.match(r"(\w+)\s*(?:=\s*(.*)|\{(.*)\})?$", part)
            if word and word[1] == name:
                return match[1], (word[2] or word[3] or "").strip()
    return None, None


def begins_as(path, file):
    """What `variable.field.field` begins as: the defaults of the structs that it goes through."""
    variable, *fields = path.split(".")
    texts = [source(other) for other in (file, file[:-4] + ".hpp") if (NODES / other).is_file()]
    kind = None
    for text in texts:
        match = re.search(rf"((?:\w+::)*[A-Z]\w*)\s*&?\s+{variable}\s*(?:;|=|\{{)", text)
        if match:
            kind = match[1]
            break
    user, value = file, None
    for field in fields:
        if kind is None:
            raise ValueError(f"nodes/{file}: cannot find what '{path}' is")
        _, user, body = declared(kind, user)
        kind, value = member(body, field)
    if value is None:
        raise ValueError(f"nodes/{file}: cannot find the default of '{path}'")
    return value, user


@functools.lru_cache(maxsize=None)
def constants():
    """Name of a constexpr: [(file, innermost namespace, expression)]."""
    found = {"M_PI": [("", "", repr(math.pi))]}
    for file in all_sources():
        text = source(file)
        for match in re.finditer(r"constexpr\s+(?:int|double|float|std::size_t|auto|(?:geometry::)?Range)\s+(k\w+[^;]*);", text):
            space = (re.findall(r"namespace tensegric_fit(?:::(\w+))?\s*\{", text[:match.start()]) or [""])[-1]
            for part in split_at_commas(match[1]):
                word = re.fullmatch(r"(k\w+)\s*(?:=\s*)?(.+)", part)
                if word:
                    found.setdefault(word[1], []).append((file, space, word[2]))
    return found


def constant(qualified, file):
    *spaces, name = qualified.split("::")
    known = constants().get(name, [])
    near = ([entry for entry in known if entry[1] == spaces[-1] and entry[0].endswith(".hpp")] if spaces else
            [entry for entry in known if entry[0] == file])
    values = {entry[2] for entry in near or known}
    if len(values) != 1:
        raise ValueError(f"nodes/{file}: '{qualified}' has {len(values)} values")
    return values.pop()


def value_of(expression, file):
    """A number, a text, or true and false; the expression itself where it is none of these."""
    expression = expression.strip()
    if text_in(expression) is not None:
        return text_in(expression)
    if expression in ("true", "false"):
        return expression
    match = re.fullmatch(r"(?:\w+::)*(?:to_string|k\w+\.of)\((.*)\)", expression)
    if match:
        return value_of(match[1], file)
    match = re.fullmatch(r'(?:\w+::)*shipped_folder\("(\w+)"\)', expression)
    if match:
        return "launch/" + match[1]
    match = re.fullmatch(r"(?:\w+::)*(\w+)\(\)(\.front\(\))?", expression)
    if match:  # a function that returns a list of words
        for other in all_sources():
            words = re.search(rf"\b{match[1]}\(\)\s*\{{[^}}]*?\{{(\"[^}}]*)\}}", source(other))
            if words:
                names = [text_in(word) for word in split_at_commas(words[1])]
                return names[0] if match[2] else names
    match = re.fullmatch(r"(?:\w+::)*(k\w+)\.all\(\)", expression)
    if match:  # geometry/enum_words.hpp
        words = {found for other in all_sources() for found in re.findall(rf"\b{match[1]}\{{\{{(.*?)\}}\}}", source(other))}
        return [text_in(word) for word in split_at_commas(words.pop())]
    if re.fullmatch(r"\{.*\}", expression):
        return [text_in(word) for word in split_at_commas(expression[1:-1])]
    end = re.fullmatch(r"((?:\w+::)*k[A-Z]\w*)\.(low|high)", expression)
    if end:
        return range_of(end[1], file)[end[2] == "high"]
    if re.fullmatch(r"\w+(\.\w+)+", expression) and not re.fullmatch(r"[\d.]+", expression):
        value, user = begins_as(expression, file)
        return value_of(value, user) if value else "none"
    if re.fullmatch(r"[A-Z]\w*::\w+|\w+::[A-Z]\w*::[a-z]\w*", expression):
        return expression.split("::")[-1]  # of an enum
    if expression == "Eigen::Vector3d::Zero()":
        return "[0, 0, 0]"

    name = r"(?:\w+::)*\b(?:k[A-Z]\w*|M_PI)\b"

    def number(match):
        return f"({re.sub(name, number, constant(match[0], file))})"
    try:
        return float(eval(re.sub(name, number, expression), {"__builtins__": {}}))  # numbers and signs alone
    except (NameError, SyntaxError, TypeError):
        return expression


def range_of(expression, file):
    """Both ends of a geometry::Range: of a constant, or written in place."""
    expression = expression.strip()
    if not expression.startswith("{"):
        here = re.search(rf"Range\s+{re.escape(expression)}\s*(\{{[^}}]*\}})", source(file))
        expression = here[1] if here else constant(expression, file)
    expression = re.sub(r"static_cast<\w+>\((\w+)\)", r"\1", expression)
    return tuple(value_of(end, file) for end in split_at_commas(expression.strip("{} ")))


# --- what there is

def parameters():
    """Node: {parameter: (kind, default, range)}; a range is (low, high), a list of words, or None."""
    found = {}
    for node, main in nodes().items():
        own = found.setdefault(node, {})
        for file in files_of(main):
            if file.startswith("ros/parameters."):
                continue
            for match, arguments in calls(source(file), r"\bparameters\.(?:" + "|".join(KINDS) + ")"):
                kind, name = match[0].split(".")[1].split("(")[0].strip(), text_in(arguments[0])
                if name is None and arguments[0] == "number.name":
                    own.update({word: (kind, default, bounds) for word, (default, bounds) in model_numbers().items()})
                    continue
                if name is None:
                    raise ValueError(f"nodes/{file}: a parameter's name is no text: {arguments[0]}")
                default = value_of(arguments[1], file) if len(arguments) > 1 else "none"
                bounds = None
                if kind == "choice":
                    bounds = value_of(arguments[2], file)
                elif len(arguments) == 3:
                    bounds = range_of(arguments[2], file)
                own[name] = (kind, default, bounds)
    return found


@functools.lru_cache(maxsize=None)
def model_numbers():
    """Name: (default, range) of what tensegric/model.hpp lists for parameters and tissue files alike."""
    file, found = "tensegric/model.hpp", {}
    text = source(file)
    start = re.search(r"kModelNumbers\[\] = ", text).end()
    for entry in split_at_commas(text[start + 1:closing(text, start)]):
        if entry:
            name, field, bounds = split_at_commas(entry[1:-1])
            default = member(declared("ModelOptions", file)[2], field.split("::")[1])[1]
            found[text_in(name)] = (value_of(default, file), range_of(bounds, file))
    return found


def keys(file):
    """Keys that a YAML reader knows: what it hands to check_keys."""
    text, found = source(file), set()
    for _, arguments in calls(text, r"\bcheck_keys"):
        words = arguments[1]
        if words == "keys":  # fit/tissue_file.cpp
            words = re.search(r"\bkeys(\{.*?\})", text, re.S)[1]
            found |= set(model_numbers())
        found |= {word for word in map(text_in, split_at_commas(words.strip("{}"))) if word}
    return found


def numbers(file):
    """Key of a YAML reader: (low, high), and what the field begins as, of those that it reads as numbers in a range."""
    found = {}
    for _, arguments in calls(source(file), r"\btake"):  # fit/tissue_file.cpp
        if arguments[0] == "number.name":
            found.update({name: bounds for name, (_, bounds) in model_numbers().items()})
        elif len(arguments) == 3 and text_in(arguments[0]):
            found[text_in(arguments[0])] = range_of(arguments[2], file)
    for _, arguments in calls(source(file), r"\bcheck"):  # tensegric/garment.cpp
        if len(arguments) == 4 and text_in(arguments[0]):
            found[text_in(arguments[0])] = range_of(arguments[2], file)
    for _, arguments in calls(source(file), r"\bnumber_in"):
        if text_in(arguments[1]):
            found[text_in(arguments[1])] = tuple(value_of(argument, file) for argument in arguments[2:4])
    return found


def topics():
    """(topic, 'from' or 'to', who): messages that a node, or rviz (panel and display), publishes or takes."""
    found = set()
    users = {node: files_of(main) for node, main in nodes().items()}
    users["rviz"] = [file for file in all_sources() if file.startswith("rviz/")]
    for who, files in users.items():
        for file in files:
            if file.startswith("rviz/") != (who == "rviz"):
                continue
            for match, arguments in calls(source(file), r"\b(?:advertise|subscribe|subscribe_from|keep|listen)"):
                topic = topic_in(arguments[match[0].startswith("subscribe_from")])  # it has the stage before its topic
                if topic:
                    found.add((topic, "from" if match[0].startswith("advertise") else "to", who))
            kept = "|".join(re.findall(r"\bKeptPublisher<[\w:]+> (\w+)", source(file)) + ["markers", "polygon_mesh", "image"])
            for _, arguments in calls(source(file), rf"\b(?:{kept})"):
                if len(arguments) == 2 and arguments[0] in ("node", "private_node") and text_in(arguments[1]):
                    found.add((("~" if arguments[0] == "private_node" else "") + text_in(arguments[1]), "from", who))
    return found


def topic_in(expression):
    match = re.fullmatch(r'(?:fmt::format\()?"([^"]*)".*', expression)
    return match[1].replace("{}", "N") if match else None


def services():
    """(name, node)."""
    return {(text_in(arguments[0]), node) for node, main in nodes().items() for file in files_of(main)
            for _, arguments in calls(source(file), r"\badvertiseService") if text_in(arguments[0])}


def actions():
    """(name, node)."""
    found = set()
    for node, main in nodes().items():
        for file in files_of(main):
            if "SimpleActionServer" in source(file):
                found |= {(text_in(arguments[1]), node) for _, arguments in calls(source(file), r"\bmake_unique<Server>")
                          if len(arguments) == 3 and text_in(arguments[1])}
    return found


def options(file):
    """Options of a program whose CLI11 is in that file."""
    text = source(file)
    found = {text_in(arguments[0]) for _, arguments in calls(text, r"\badd_(?:option|flag)") if text_in(arguments[0])}
    found |= {text_in(arguments[0]) for _, arguments in calls(text, r"\btuple") if text_in(arguments[0])}
    return {name for name in found if name.startswith("--")}
