// For tests/house/browsers, where tsc looks for names that no browser of the floor knows. A selector, or an event, does not tell which kind of
// element it is of: each has what the kinds in use have.
interface Element {
  checked: any; dataset: any; disabled: any; field: any; files: any; focus: any; getContext: any; height: any; hidden: any;
  style: any; title: any; value: any; width: any;
}
interface EventTarget {
  checked: any; clientHeight: any; closest: any; dataset: any; localName: any; scrollHeight: any; scrollTop: any; type: any;
}
interface ParentNode { scrollTop: any; title: any }
interface Event { detail: any; key: any; ports: any; x: any; y: any }
interface HTMLElement { noValidate: any }
interface HTMLFormControlsCollection { code: any }
