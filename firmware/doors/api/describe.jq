# Writes the description of the API, OpenAPI 3.1, at build time: `paths` from the rows of routes.cpp ($routes, its text), what
# they name in openapi.json ($parts), and the schemas of the rows ($rows: described.cpp).
def strings: [scan("\"(?:[^\"\\\\]|\\\\.)*\"") | fromjson];
def words: (. // "") | split(" ") | map(select(. != ""));
def known($what; $all): . as $name | $all[$name] // error("openapi.json has no \($name) among its \($what)");
def reference($kind): {"$ref": "#/components/\($kind)/\(.)"};

# Each row of the table: get(path, who, handle_of<...>(), words...), or post(path, who, body, handle_of<...>(), takes, words...).
def rows:
  "\"(?:[^\"\\\\]|\\\\.)*\"" as $string
  | (split("kRoutes[] = {\n")[1] | split("\n};")[0] | gsub("\"\\s*\n\\s*\""; "")) as $table # adjacent literals are one
  | "(get|post)\\((\($string)),\\s*(\\w+),\\s*(?:(kJson|kBundle|kCertificate|kExport)[<>\\d]*,\\s*)?handle_of<[^()]*>\\(\\),\\s*((?:\($string)[,\\s]*)+)\\)" as $row
  | [$table | scan($row) as [$method, $path, $who, $body, $words]
     | ["takes", "tag", "summary", "done", "gives", "refusals", "parameters"][if $method == "get" then 1 else 0 end:] as $names
     | [$words | strings[]] as $values
     | {method: $method, path: ($path | fromjson), who: $who, body: $body}
       + ([range($values | length) | {($names[.]): $values[.]}] | add)]
  | if length == ([$table | scan("(?:^|\n)    (?:get|post)\\(")] | length) then .[] else error("a row of routes.cpp is not understood") end;

$parts[0] as $parts | ($parts.schemas + $rows[0]) as $schemas

# The schema of an object that has these members and no others.
| def closed: {type: "object", properties: ., required: keys_unsorted, additionalProperties: false};

def content:
  if . == "text/event-stream" then {(.): {"x-event": ("RunView" | reference("schemas"))}}
  elif contains("/") then {(.): {}}
  else {"application/json": {schema: (
    if startswith("[") then {type: "array", items: (.[1:-1] | reference("schemas"))}
    elif $schemas[.] then reference("schemas")
    else known("answers"; $parts.answers) | if (.type | type) == "string" then . else closed end end)}}
  end;

# It may be left out where nothing in it is required.
def body:
  (.body | IN("kBundle", "kCertificate", "kExport")) as $bundle | (.takes | known("bodies"; $parts.bodies)) as $body
  | {required: ($bundle or ($body.schema | has("required") or has("$ref")))}
  + ($body | with_entries(select(.key == "description")))
  + {content: {(if $bundle then "application/octet-stream" else "application/json" end): ($body | del(.description))}};

# What it gives is answered with 200: "202 ..." says 202, and "204 ..." that there may be none of it.
def responses:
  (.gives | capture("^((?<code>20[24]) )?(?<what>.*)")) as {$code, $what}
  | {(if $code == "202" then $code else "200" end): {description: .done, content: ($what | content)}}
  + (if $code == "204" then {($code): {description: "There is none."}} else {} end)
  + ([(.refusals | words[]), (if .who != "Open" then "403" else empty end),
      (if .who | IN("Open", "OwnPage") then empty else "401", "429" end), (if .body then "413", "422" else empty end)]
     | sort | map({(.): reference("responses")}) | add);

def operation:
  {tags: [.tag], summary}
  + (if .who | IN("Open", "OwnPage") then {security: []}
     else {"x-adit-role": (if .who == "Viewer" then "viewer" else "operator" end)} end)
  + (.parameters | words | map(known("parameters"; $parts.parameters)) | if . == [] then {} else {parameters: .} end)
  + (if .body then {requestBody: body} else {} end)
  + {responses: responses};

$parts.frame
+ {paths: (reduce ($routes | rows) as $row ({}; .[$row.path][$row.method] = ($row | operation))),
   components: {securitySchemes: $parts.securitySchemes,
                responses: ($parts.refusals | map_values(. + {content: ("Error" | reference("schemas") | {"application/json": {schema: .}})})),
                schemas: $schemas}}
