"""scripts/lengths.py finds what is too long, and nothing else."""

import contextlib
import importlib.util
import io
import os
import sys
import tempfile
import unittest
from unittest import mock

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
spec = importlib.util.spec_from_file_location("lengths", os.path.join(ROOT, "scripts", "lengths.py"))
lengths = importlib.util.module_from_spec(spec)
spec.loader.exec_module(lengths)


def body(lines):
    """Statements, one a line."""
    return "".join(f"    x += {i};\n" for i in range(lines))


def measured(code):
    """Name -> lines of the functions in a piece of code."""
    return {name: count for name, first, count in lengths.functions(code)}


class Functions(unittest.TestCase):
    def test_a_function_is_measured_from_its_type_to_its_brace(self):
        code = "// A comment.\nint\nadd(int a,\n    int b) {\n" + body(7) + "}\n"
        self.assertEqual(lengths.functions(code), [("add", 2, 11)])

    def test_every_kind_of_function(self):
        for head, name in [("void f() {", "f"),
                           ("template <typename T = int>\nT f(T x = T{}) {", "f"),
                           ("bool operator==(const A& a, const A& b) {", "operator=="),
                           ("A::A(int x) : a_{x}, b_(x), c_{x} {", "A::A"),
                           ("A::~A() {", "A::~A"),
                           ("auto A::f() const noexcept -> int {", "A::f"),
                           ("int f(std::vector<int> x = {1, 2}) {", "f"),
                           ("[[nodiscard]] static std::map<int, int> f(int) {", "f"),
                           ("const auto f = [](int x) {", "a lambda"),
                           ("layout(local_size_x = 8) in;\nPARAMS(A)\nBUFFER(readonly, 1, vec4, b)\nvoid main() {", "main")]:
            for within in ["%s", "namespace a {\n%s}\n", "class A {\npublic:\n%s};\n", 'extern "C" {\n%s}\n']:
                with self.subTest(head=head, within=within):
                    code = within % (head + "\n    if (x) {\n" + body(3) + "    }\n}\n")
                    lines = 8 if head.startswith("template") else 7
                    self.assertEqual(measured(code), {name: lines})

    def test_what_is_no_function(self):
        for code in ["struct A {\n    int x = 0;\n    std::vector<int> y{1, 2};\n};\n",
                     "struct alignas(16) A {\n    int x;\n};\n",
                     "enum class A : int {\n    b,\n    c\n};\n",
                     "const int table[] = {\n    f(1),\n    f(2),\n};\n",
                     "const std::map<int, int> table = {\n    {1, 2},\n    {3, 4},\n};\n",
                     "layout(std430, binding = 0) buffer A {\n    int x;\n} a;\n",
                     "namespace a::b {\nint x;\n}\n"]:
            with self.subTest(code=code):
                self.assertEqual(lengths.functions(code), [])

    def test_braces_in_texts_open_nothing(self):
        code = ("void f() {\n    // }\n    /* } */\n    a = \"}\\\"}\";\n    b = '}';\n    c = R\"x(\n}\n)x\";\n"
                "    d = 1'000'000;\n}\nvoid g() {\n}\n")
        self.assertEqual(measured(code), {"f": 10, "g": 2})

    def test_each_branch_of_a_condition_is_measured(self):
        code = ("#ifdef __cplusplus\nnamespace a {\n#define F inline\n#else\n#define F\n#endif\n"
                "F int f(int x) {\n#if A\n    if (x) {\n#else\n    if (!x) {\n#endif\n    }\n}\n"
                "#if B\nvoid g() {\n}\n#else\nvoid h() {\n\n}\n#endif\n#ifdef __cplusplus\n}\n#endif\n")
        self.assertEqual(measured(code), {"f": 8, "g": 2, "h": 3})

    def test_a_macro_of_several_lines_is_a_function(self):
        self.assertEqual(measured("#define F(x) \\\n    g(x); \\\n    h(x)\nvoid f() {}\n"), {"F": 3, "f": 1})

    def test_what_is_not_closed_is_said(self):
        for code in ["void f() {\n", "}\n", "void f() { g( }\n"]:
            with self.subTest(code=code), self.assertRaises(lengths.NotUnderstood):
                lengths.functions(code)


class Program(unittest.TestCase):
    def run_on(self, files):
        """Exit status and lines of the check of a folder with these files."""
        with tempfile.TemporaryDirectory() as folder:
            for name, text in files.items():
                os.makedirs(os.path.dirname(os.path.join(folder, name)), exist_ok=True)
                with open(os.path.join(folder, name), "w", encoding="utf-8") as file:
                    file.write(text)
            out, err = io.StringIO(), io.StringIO()
            with mock.patch.object(sys, "argv", ["lengths.py", folder]), contextlib.redirect_stdout(out), \
                    contextlib.redirect_stderr(err):
                status = lengths.main()
            return status, out.getvalue().splitlines(), err.getvalue()

    def test_at_the_limits_nothing_is_said(self):
        files = {"a.cpp": "int x;\n" * 500, "b.h": "void f() {\n" + body(58) + "}\n", "report.html": "<p>\n" * 501}
        self.assertEqual(self.run_on(files), (0, [], ""))

    def test_a_line_above_them_is_found(self):
        for name, text, says in [("long.cpp", "int x;\n" * 501, "501 lines"),
                                 ("a/CMakeLists.txt", "# x\n" * 501, "501 lines"),
                                 ("other.html", "<p>\n" * 501, "501 lines"),
                                 ("a/b/long.h", "void f() {\n" + body(59) + "}\n", "long.h:1: f has 61 lines"),
                                 ("long.comp", "\nvoid main() {\n" + body(59) + "}\n", "long.comp:2: main has 61")]:
            with self.subTest(name=name):
                status, lines, complaint = self.run_on({name: text, "good.cpp": "int x;\n"})
                self.assertEqual((status, len(lines), complaint), (1, 1, ""))
                self.assertIn(says, lines[0])

    def test_what_cannot_be_read_is_an_error_of_its_own(self):
        status, lines, complaint = self.run_on({"a.cpp": "void f() {\n"})
        self.assertEqual((status, lines), (2, []))
        self.assertIn("a.cpp", complaint)
        with mock.patch.object(sys, "argv", ["lengths.py", "/nowhere"]), contextlib.redirect_stderr(io.StringIO()):
            self.assertEqual(lengths.main(), 2)


if __name__ == "__main__":
    unittest.main()
