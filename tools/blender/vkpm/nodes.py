"""Looks at shader nodes: constants, links, outputs."""


def output(tree, kind):
    """The active output node of a tree ("OUTPUT_MATERIAL", "OUTPUT_WORLD", "OUTPUT_LIGHT"); None without one."""
    found = [node for node in tree.nodes if node.type == kind and node.target in ("ALL", "CYCLES")]
    return next((node for node in found if node.is_active_output), found[0] if found else None)


def source(socket):
    """The node linked to a socket through reroutes, muted nodes left aside; None if there is none."""
    while socket is not None and socket.is_linked:
        link = socket.links[0]
        node = link.from_node
        if node.type == "REROUTE":
            socket = node.inputs[0]
        elif node.mute:
            inner = next((inner for inner in node.internal_links if inner.to_socket == link.from_socket), None)
            socket = inner.from_socket if inner else None
        else:
            return node
    return None


def constant(node, *names):
    """The value of the first input of one of these names, also by an RGB or Value node; None if another node computes
    it or there is no such input."""
    socket = next((node.inputs[name] for name in names if name in node.inputs), None)
    if socket is None:
        return None
    other = source(socket)
    if other is None:
        return socket.default_value
    if other.type in ("RGB", "VALUE"):
        return other.outputs[0].default_value
    return None
